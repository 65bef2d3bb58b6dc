#include "sdf_state.hpp"

#include <array>
#include <cmath>

#include "quadcore/text.hpp"

namespace quadcore {
namespace {

using Element = Xml::Element;

std::string name_of_saved(const Element& e) {
  const char* name = e.Attribute("name");
  return name ? name : "";
}

/// Return the six numbers in an element, or zeros if it is empty.
std::array<Vector3d, 2> read_six(const Xml& xml, const Element& e, const std::string& text) {
  std::array<Vector3d, 2> halves = {Vector3d::Zero(), Vector3d::Zero()};
  const std::vector<std::string> words = split(text);
  if (words.empty()) return halves;
  for (std::size_t i = 0; i < 6 && words.size() == 6; ++i) {
    const auto number = parse_number(words[i]);
    if (!number || std::abs(*number) > 1e9) break;
    halves[i / 3][static_cast<Eigen::Index>(i % 3)] = *number;
    if (i == 5) return halves;
  }
  xml.fail(e, "<" + std::string(e.Name()) + "> is '" + text + "'. Write six finite numbers.");
}

SavedLink read_saved_link(const Xml& xml, const Element& saved) {
  SavedLink link;
  if (const Element* pose = xml.child(saved, "pose")) link.pose_W = read_placement(xml, *pose);
  if (const Element* velocity = xml.child(saved, "velocity")) {
    const auto halves = read_six(xml, *velocity, xml.text(*velocity));
    link.linear_velocity_W = halves[0];
    link.angular_velocity_W = halves[1];
  }
  return link;
}

SavedModel read_saved_model(const Xml& xml, const Element& saved) {
  SavedModel model;
  if (const Element* pose = xml.child(saved, "pose")) model.pose_W = read_placement(xml, *pose);
  const Element* scale = xml.child(saved, "scale");
  if (scale && !xml.text(*scale).empty()) {
    model.scale = xml.vector_in_text(*scale);
    if (!(model.scale.minCoeff() > 0)) xml.fail(*scale, "<scale> is not positive. Correct it.");
  }
  for (const Element* e = xml.child(saved, "link"); e; e = e->NextSiblingElement("link")) {
    model.links.emplace(name_of_saved(*e), read_saved_link(xml, *e));
  }
  for (const Element* e = xml.child(saved, "model"); e; e = e->NextSiblingElement("model")) {
    model.models.emplace(name_of_saved(*e), read_saved_model(xml, *e));
  }
  return model;
}

/// Read "seconds nanoseconds".
double read_time(const Xml& xml, const Element& time) {
  const std::vector<std::string> words = split(xml.text(time));
  if (words.empty()) return 0;
  const auto whole = parse_number(words[0]);
  const auto nano = words.size() == 2 ? parse_number(words[1]) : std::optional<double>(0);
  if (words.size() > 2 || !whole || !nano || *whole < 0 || *nano < 0 || *whole > 1e9 ||
      *nano >= 1e9) {
    xml.fail(time, "<sim_time> is '" + xml.text(time) + "'. Write seconds and nanoseconds.");
  }
  return *whole + *nano * 1e-9;
}

}  // namespace

Placement read_placement(const Xml& xml, const Element& pose) {
  const std::string text = xml.text(pose, {"relative_to"});
  const auto halves = read_six(xml, pose, text);
  return {halves[0], quaternion_from_rpy(halves[1])};
}

SavedState read_saved_state(const Xml& xml, const Element& world) {
  SavedState saved;
  const Element* state = xml.child(world, "state");
  if (!state) return saved;
  if (const Element* time = xml.child(*state, "sim_time")) saved.time = read_time(xml, *time);
  for (const Element* e = xml.child(*state, "model"); e; e = e->NextSiblingElement("model")) {
    saved.models.emplace(name_of_saved(*e), read_saved_model(xml, *e));
  }
  for (const Element* e = xml.child(*state, "insertions"); e;
       e = e->NextSiblingElement("insertions")) {
    saved.inserted.push_back(e);
  }
  for (const Element* e = xml.child(*state, "deletions"); e;
       e = e->NextSiblingElement("deletions")) {
    for (const Element* n = xml.child(*e, "name"); n; n = n->NextSiblingElement("name")) {
      saved.deleted.insert(xml.text(*n));
    }
  }
  return saved;
}

}  // namespace quadcore
