#include "sdf_frames.hpp"

#include "quadcore/text.hpp"

namespace quadcore {
namespace {

constexpr int longest_chain_of_frames = 100;

std::string attribute_or_empty(const Xml::Element& element, const char* name) {
  const char* value = element.Attribute(name);
  return value ? trimmed(value) : "";
}

}  // namespace

SdfFrames::SdfFrames(const Xml& xml, const Xml::Element& owner, bool has_frames)
    : xml_(xml), has_frames_(has_frames) {
  if (!has_frames) return;
  for (const auto* e = owner.FirstChildElement(); e; e = e->NextSiblingElement()) {
    const std::string kind = e->Name();
    if (kind != "frame" && kind != "link" && kind != "model" && kind != "joint") continue;
    frames_.emplace(attribute_or_empty(*e, "name"), e);
  }
}

Placement SdfFrames::find_pose(const Xml::Element& element) const { return find_pose(element, 0); }

Placement SdfFrames::find_pose(const Xml::Element& element, int depth) const {
  const Xml::Element* pose = xml_.child(element, "pose");
  const Placement own = pose ? read_placement(xml_, *pose) : Placement();
  if (!has_frames_) return own;
  std::string base = pose ? attribute_or_empty(*pose, "relative_to") : "";
  const std::string kind = element.Name();
  if (base.empty() && kind == "frame") base = attribute_or_empty(element, "attached_to");
  if (base.empty() && kind == "joint") {
    const Xml::Element* child = xml_.child(element, "child");
    if (child) base = xml_.text(*child);
  }
  if (base.empty()) return own;
  return find_frame(pose ? *pose : element, base, depth) * own;
}

Placement SdfFrames::find_frame(const Xml::Element& element, const std::string& name) const {
  return find_frame(element, name, 0);
}

Placement SdfFrames::find_frame(const Xml::Element& element, const std::string& name,
                                int depth) const {
  if (name == "__model__" || name == "world") return {};
  const auto frame = frames_.find(name);
  if (frame == frames_.end()) {
    xml_.fail(element, "the frame '" + name + "' does not exist. Correct its name.");
  }
  if (depth == longest_chain_of_frames) {
    xml_.fail(element, "the frame '" + name + "' is relative to itself. Correct <pose>.");
  }
  return find_pose(*frame->second, depth + 1);
}

}  // namespace quadcore
