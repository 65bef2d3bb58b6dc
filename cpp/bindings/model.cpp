#include "quadcore/model.hpp"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include "bindings.hpp"
#include "built.hpp"
#include "quadcore/document.hpp"
#include "quadcore/error.hpp"
#include "quadcore/gazebo_reference.hpp"
#include "quadcore/seen_or_sensed.hpp"
#include "quadcore/text.hpp"
#include "quadcore/world.hpp"
#include "unpickled.hpp"

namespace quadcore::bindings {
namespace {

/// Of what a pickled model or world holds.
constexpr int version = 1;

const Source& source_of(const std::shared_ptr<const Source>& source) {
  if (!source) {
    throw InputError("this model is as its engine rounded it; pickle the one that was read");
  }
  return *source;
}

using Places = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// Row i: origin of the link that joint i carries, from that of the frame, in its axes [m].
Places joint_places(const Model& model) {
  const std::vector<Eigen::Isometry3d> poses = link_poses(model);
  Places places(static_cast<Eigen::Index>(model.joints.size()), 3);
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    places.row(static_cast<Eigen::Index>(i)) = poses[i + 1].translation();
  }
  return places;
}

/// Pickles by the document, and reads that again: no path, and nothing that could be torn.
template <class Read>
auto by_document(Read (*read)(const Document&, const std::vector<std::string>&)) {
  return py::pickle(
      [](const Built<Read>& held) -> py::object {
        const auto& [document, ignore] = source_of(held->source);
        return py::make_tuple(version, document.name, document.text, document.lines, ignore);
      },
      [read](const py::object& state) {
        return unpickled("a model or world", "read", [&] {
          if (py::cast<int>(state[py::int_(0)]) != version) throw OtherVersion();
          return std::make_shared<Read>(read(
              {py::cast<std::string>(state[py::int_(1)]), py::cast<std::string>(state[py::int_(2)]),
               py::cast<std::vector<std::pair<std::string, int>>>(state[py::int_(3)])},
              py::cast<std::vector<std::string>>(state[py::int_(4)])));
        });
      });
}

}  // namespace

void bind_model(py::module_& m) {
  py::class_<Document>(m, "Document", "An XML text and where its lines came from.")
      .def(py::init([](std::string name, std::string text,
                       std::vector<std::pair<std::string, int>> lines) {
             return Document{std::move(name), std::move(text), std::move(lines)};
           }),
           py::arg("name"), py::arg("text"),
           py::arg("lines") = std::vector<std::pair<std::string, int>>{})
      .def_readonly("name", &Document::name)
      .def_readonly("text", &Document::text)
      .def_readonly("lines", &Document::lines)
      .def_property_readonly_static("largest", [](const py::object&) { return Document::largest; })
      .def_property_readonly_static("most_levels",
                                    [](const py::object&) { return Document::most_levels; })
      .def_property_readonly_static("most_attributes",
                                    [](const py::object&) { return Document::most_attributes; });

  py::class_<PassedOver>(m, "PassedOver", "What a reader met and did not take in.")
      .def_property_readonly("ignored", &PassedOver::ignored)
      .def_property_readonly("warning", &PassedOver::warning);

  py::class_<Unfelt>(m, "Unfelt", "An element or a module that no vehicle feels.")
      .def_readonly("name", &Unfelt::name)
      .def_readonly("parent", &Unfelt::parent)
      .def_readonly("what", &Unfelt::what);

  py::class_<Collision>(m, "Collision", "A shape that may touch the ground.")
      .def_readonly("where", &Collision::where)
      .def_property_readonly("size", [](const Collision& c) -> Vector3d { return c.size; })
      .def_property_readonly("xyz", [](const Collision& c) -> Vector3d { return c.pose.xyz; })
      .def_property_readonly("rpy", [](const Collision& c) -> Vector3d { return c.pose.rpy; });

  py::class_<Link>(m, "Link", "A moving body: a link and every link fixed to it.")
      .def_readonly("name", &Link::name)
      .def_readonly("where", &Link::where)
      .def_property_readonly("mass", [](const Link& link) { return link.inertial.mass; })
      .def_property_readonly("center_of_mass",
                             [](const Link& link) -> Vector3d { return link.inertial.pose.xyz; })
      .def_property_readonly("inertia",
                             [](const Link& link) { return link.inertial.inertia_in_link_axes(); })
      .def_readonly("collisions", &Link::collisions);

  py::class_<Joint>(m, "Joint", "A continuous joint.")
      .def_readonly("name", &Joint::name)
      .def_readonly("where", &Joint::where)
      .def_readonly("damping", &Joint::damping)
      .def_property_readonly("axis", [](const Joint& joint) -> Vector3d { return joint.axis; })
      .def_property_readonly("xyz", [](const Joint& joint) -> Vector3d { return joint.pose.xyz; })
      .def_property_readonly("rpy", [](const Joint& joint) -> Vector3d { return joint.pose.rpy; });

  py::class_<Model, std::shared_ptr<Model>>(m, "Model", "A vehicle: bodies, joints, plugins.")
      .def_property_readonly("name", [](const Built<Model>& held) { return held->name; })
      .def_property_readonly("links", [](const Built<Model>& held) { return held->links; })
      .def_property_readonly("joints", [](const Built<Model>& held) { return held->joints; })
      .def_property_readonly("joint_places",
                             [](const Built<Model>& held) { return joint_places(*held); })
      .def_property_readonly("warnings", [](const Built<Model>& held) { return held->warnings; })
      .def_property_readonly("passed_over",
                             [](const Built<Model>& held) { return held->passed_over; })
      .def_property_readonly(
          "document", [](const Built<Model>& held) { return source_of(held->source).document; })
      .def(by_document(&read_model));

  py::class_<World, std::shared_ptr<World>>(m, "World", "What a world file sets.")
      .def_property_readonly("gravity",
                             [](const Built<World>& held) -> Vector3d { return held->gravity_W; })
      .def_property_readonly("wind",
                             [](const Built<World>& held) -> Vector3d { return held->wind_W; })
      .def_property_readonly(
          "magnetic_field",
          [](const Built<World>& held) -> Vector3d { return held->magnetic_field_W; })
      .def_property_readonly("max_step_size",
                             [](const Built<World>& held) { return held->max_step_size; })
      .def_property_readonly("real_time_update_rate",
                             [](const Built<World>& held) { return held->real_time_update_rate; })
      .def_property_readonly("ground_plane",
                             [](const Built<World>& held) { return held->ground_plane; })
      .def_property_readonly("passed_over",
                             [](const Built<World>& held) { return held->passed_over; })
      .def_property_readonly(
          "document", [](const Built<World>& held) { return source_of(held->source).document; })
      .def(by_document(&read_world));

  m.def("parse_number", &parse_number, py::arg("text"),
        "The finite number that a text is, as in a URDF; None otherwise.");
  py::class_<GazeboTag>(m, "GazeboTag", "What a <gazebo reference> may hold.")
      .def_readonly("name", &GazeboTag::name)
      .def_readonly("of", &GazeboTag::of)
      .def_readonly("felt_by", &GazeboTag::felt_by)
      .def_readonly("unit", &GazeboTag::unit)
      .def_readonly("default", &GazeboTag::fallback)
      .def_readonly("range", &GazeboTag::range)
      .def_readonly("meaning", &GazeboTag::meaning);
  m.def("gazebo_tags", &gazebo_tags, "What a <gazebo reference> may hold, the felt tags first.");

  const auto nothing = std::vector<std::string>{};
  m.def("read_model", &read_model, py::arg("document"), py::arg("ignore") = nothing,
        "Reads a URDF as Gazebo does: fixed links are lumped. Raises InputError with FILE:LINE.");
  m.def("read_world", &read_world, py::arg("document"), py::arg("ignore") = nothing,
        "Reads a world file. Raises InputError with FILE:LINE.");
  m.def("check_ignored", &check_ignored, py::arg("ignore"), py::arg("readings"),
        "Raises InputError if a name to ignore was met in none of what was read.");
  m.def("everything_unfelt", &everything_unfelt,
        "Every element and module that is known to be seen or sensed only.");
}

}  // namespace quadcore::bindings
