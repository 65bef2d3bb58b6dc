#include "quadcore/plugin/model.hpp"

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "arguments.hpp"
#include "bindings.hpp"
#include "built.hpp"
#include "quadcore/drawing.hpp"
#include "quadcore/gazebo_reference.hpp"
#include "quadcore/plugin/document.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/plugin/world.hpp"
#include "quadcore/seen_or_sensed.hpp"
#include "quadcore/text.hpp"
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

/// Row i: on the far side along axis k of the box where bit k of i is set [m].
py::array_t<double> corners_of_box(const Link& link) {
  const InertiaBox box = inertia_box(link.inertial);
  Eigen::Matrix<double, 8, 3, Eigen::RowMajor> corners;
  for (int i = 0; i < 8; ++i) {
    const Vector3d sides((i & 1) - 0.5, (i >> 1 & 1) - 0.5, (i >> 2 & 1) - 0.5);
    corners.row(i) = box.center + box.orientation * sides.cwiseProduct(box.edges);
  }
  return py::cast(corners);
}

/// Pose i: of link i in the frame [m], as a homogeneous matrix.
py::array_t<double> poses_of_links(const Model& model) {
  const std::vector<Eigen::Isometry3d> poses = link_poses(model);
  py::array_t<double> matrices(
      {static_cast<py::ssize_t>(poses.size()), py::ssize_t{4}, py::ssize_t{4}});
  for (std::size_t i = 0; i < poses.size(); ++i) {
    Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(matrices.mutable_data() + 16 * i) =
        poses[i].matrix();
  }
  return matrices;
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

/// Getter of a member of a model or world.
template <class T, class Member>
auto get(Member T::* member) {
  return [member](const Built<T>& built) -> Member { return (*built).*member; };
}

/// Getter of the document that a model or world was read from.
template <class T>
Document get_document(const Built<T>& built) {
  return source_of(built->source).document;
}

void bind_documents(py::module_& m) {
  py::class_<Document>(m, "Document", R"(An XML text and where its lines came from.

Attributes
----------
largest : int
    Bytes that a text may have.
most_levels, most_attributes : int
    Levels of elements that a text may have, and attributes of one element.)")
      .def(py::init([](std::string name, std::string text,
                       std::vector<std::pair<std::string, int>> lines) {
             return Document{std::move(name), std::move(text), std::move(lines)};
           }),
           py::arg("name"), py::arg("text"),
           py::arg("lines") = std::vector<std::pair<std::string, int>>{})
      .def("__repr__",
           [](const Document& d) {
             return py::str("<Document '{}', {} characters>").format(text(d.name), d.text.size());
           })
      .def_readonly("name", &Document::name, "File that it is, for errors.")
      .def_readonly("text", &Document::text, "The XML.")
      .def_readonly("lines", &Document::lines,
                    "File and line that each line of an expanded text stems from; empty if the "
                    "text is the file.")
      .def_property_readonly_static("largest", [](const py::object&) { return Document::largest; })
      .def_property_readonly_static("most_levels",
                                    [](const py::object&) { return Document::most_levels; })
      .def_property_readonly_static("most_attributes",
                                    [](const py::object&) { return Document::most_attributes; });

  py::class_<PassedOver>(m, "PassedOver", "What a reader met and did not take in.")
      .def_property_readonly("ignored", &PassedOver::ignored,
                             "Names of what was left out because the user asked for it.")
      .def_property_readonly(
          "warning", &PassedOver::warning,
          "What was left out because nothing feels it, in one line; \"\" if nothing was.");

  py::class_<Unfelt>(m, "Unfelt", "An element or a module that no vehicle feels.")
      .def_readonly("name", &Unfelt::name, "Of the element, or file name of the module.")
      .def_readonly("parent", &Unfelt::parent,
                    "Element around it, such as \"robot/link\"; \"\" for a module.")
      .def_readonly("what", &Unfelt::what, "What it is.");
}

void bind_bodies(py::module_& m) {
  py::class_<Collision>(m, "Collision", "A shape that may touch the ground.")
      .def_readonly("where", &Collision::where, "FILE:LINE.")
      .def_property_readonly(
          "size", [](const Collision& c) -> Vector3d { return c.size; },
          "Box x, y, z; cylinder radius, length, 0; sphere radius, 0, 0; m, shape (3,).")
      .def_property_readonly(
          "xyz", [](const Collision& c) -> Vector3d { return c.pose.xyz; },
          "Place in the link's axes, m; shape (3,).")
      .def_property_readonly(
          "rpy", [](const Collision& c) -> Vector3d { return c.pose.rpy; },
          "Roll, pitch, yaw in the link, rad; shape (3,).");

  py::class_<Link>(m, "Link", "A moving body: a link and every link fixed to it.")
      .def_readonly("name", &Link::name, "Of the link that carries those fixed to it.")
      .def_readonly("where", &Link::where, "FILE:LINE.")
      .def_property_readonly(
          "mass", [](const Link& link) { return link.inertial.mass; }, "kg.")
      .def_property_readonly(
          "center_of_mass", [](const Link& link) -> Vector3d { return link.inertial.pose.xyz; },
          "In the link's axes, from its origin, m; shape (3,).")
      .def_property_readonly(
          "inertia", [](const Link& link) { return link.inertial.inertia_in_link_axes(); },
          "About the centre of mass, along the link's axes, kg m^2; shape (3, 3).")
      .def_property_readonly("inertia_box", &corners_of_box,
                             "Corners of the homogeneous box that has its mass and inertia, in the "
                             "link's axes, m; shape (8, 3).")
      .def("__repr__",
           [](const Link& link) {
             return py::str("<Link '{}', {:.6g} kg>").format(text(link.name), link.inertial.mass);
           })
      .def_readonly("collisions", &Link::collisions,
                    "Shapes that may touch the ground, list of Collision.");

  py::class_<Joint>(m, "Joint", "A continuous joint.")
      .def("__repr__",
           [](const Joint& joint) { return py::str("<Joint '{}'>").format(text(joint.name)); })
      .def_readonly("name", &Joint::name, "Of the joint.")
      .def_readonly("where", &Joint::where, "FILE:LINE.")
      .def_readonly("damping", &Joint::damping, "N m s/rad.")
      .def_property_readonly(
          "axis", [](const Joint& joint) -> Vector3d { return joint.axis; },
          "Unit vector in the child link's axes; a positive velocity turns about it by the "
          "right-hand rule; shape (3,).")
      .def_property_readonly(
          "xyz", [](const Joint& joint) -> Vector3d { return joint.pose.xyz; },
          "Origin of the child link in the parent link, m; shape (3,).")
      .def_property_readonly(
          "rpy", [](const Joint& joint) -> Vector3d { return joint.pose.rpy; },
          "Roll, pitch, yaw of the child link in the parent link at angle zero, rad; shape (3,).");
}

void bind_vehicle(py::module_& m) {
  py::class_<Model, std::shared_ptr<Model>>(m, "Model", "A vehicle: bodies, joints, plugins.")
      .def_property_readonly("name", get(&Model::name), "Of the robot.")
      .def_property_readonly(
          "links", get(&Model::links),
          "Bodies, list of Link: the frame, then of each joint the link that it carries.")
      .def_property_readonly("joints", get(&Model::joints),
                             "Continuous joints in the file's order, list of Joint.")
      .def_property_readonly(
          "link_poses", [](const Built<Model>& held) { return poses_of_links(*held); },
          "Pose of each of `links` in the frame, all joints at angle zero: homogeneous matrices, "
          "m; shape (n + 1, 4, 4).")
      .def_property_readonly(
          "drawn_disc_radius", [](const Built<Model>& held) { return drawn_disc_radius(*held); },
          "Of the rotors' discs in pictures, so that none covers another, m.")
      .def_property_readonly(
          "joint_places", [](const Built<Model>& held) { return joint_places(*held); },
          "Origin of each joint's link from the frame's, in the frame's axes, all joints at angle "
          "zero, m; shape (n, 3).")
      .def_property_readonly("warnings", get(&Model::warnings),
                             "What is allowed but was perhaps not meant, list of str.")
      .def_property_readonly("passed_over", get(&Model::passed_over),
                             "What the reader did not take in.")
      .def_property_readonly("document", &get_document<Model>, "The text that it was read from.")
      .def("__repr__",
           [](const Built<Model>& held) {
             return py::str("<Model '{}', {:.6g} kg, {} rotors>")
                 .format(text(held->name), mass_properties(*held).mass, held->joints.size());
           })
      .def(by_document(&read_model));
}

void bind_world(py::module_& m) {
  py::class_<World, std::shared_ptr<World>>(m, "World", "What a world file sets.")
      .def_property_readonly("gravity", get(&World::gravity_W), "World axes, m/s^2; shape (3,).")
      .def_property_readonly("wind", get(&World::wind_W),
                             "Velocity of the air, world axes, m/s; shape (3,).")
      .def_property_readonly("magnetic_field", get(&World::magnetic_field_W),
                             "World axes (x east, y north, z up), T; shape (3,).")
      .def_property_readonly("max_step_size", get(&World::max_step_size),
                             "Length of a step unless a simulation is given another, s.")
      .def_property_readonly(
          "real_time_update_rate", get(&World::real_time_update_rate),
          "Steps per second of real time of what paces itself; 0 is as fast as possible.")
      .def_property_readonly("ground_plane", get(&World::ground_plane),
                             "Whether there is ground at z = 0.")
      .def_property_readonly("passed_over", get(&World::passed_over),
                             "What the reader did not take in.")
      .def_property_readonly("document", &get_document<World>, "The text that it was read from.")
      .def("__repr__",
           [](const Built<World>& held) {
             const Vector3d& g = held->gravity_W;
             return py::str("<World, gravity ({:g}, {:g}, {:g}) m/s^2, steps of {:g} s, {}>")
                 .format(g.x(), g.y(), g.z(), held->max_step_size,
                         held->ground_plane ? "ground" : "no ground");
           })
      .def(by_document(&read_world));
}

void bind_readers(py::module_& m) {
  m.def("parse_number", &parse_number, py::arg("text"),
        "The finite number that a text is, as in a URDF; None otherwise.");
  py::class_<GazeboTag>(m, "GazeboTag", "What a <gazebo reference> may hold.")
      .def_readonly("name", &GazeboTag::name, "Of the tag.")
      .def_readonly("of", &GazeboTag::of, "What the reference must name: link or joint.")
      .def_readonly("felt_by", &GazeboTag::felt_by,
                    "What feels it: shapes, body or joint; \"\" if nothing does.")
      .def_readonly("unit", &GazeboTag::unit, "\"\" without one.")
      .def_readonly("default", &GazeboTag::fallback, "Value without the tag; \"\" without one.")
      .def_readonly("range", &GazeboTag::range, "Values that it may have, for a person.")
      .def_readonly("meaning", &GazeboTag::meaning, "In one line.");
  m.def("gazebo_tags", &gazebo_tags, "What a <gazebo reference> may hold, the felt tags first.");
  m.def("world_elements", &world_elements,
        "Elements that a world may hold, by their paths below <world>.");
  m.def("everything_unfelt", &everything_unfelt,
        "Every element and module that is known to be seen or sensed only.");

  const auto nothing = std::vector<std::string>{};
  m.def("read_model", &read_model, py::arg("document"), py::arg("ignore") = nothing,
        "Reads a URDF as Gazebo does: fixed links are lumped. Raises InputError with FILE:LINE.");
  m.def("read_world", &read_world, py::arg("document"), py::arg("ignore") = nothing,
        "Reads a world file. Raises InputError with FILE:LINE.");
  m.def("check_ignored", &check_ignored, py::arg("ignore"), py::arg("readings"),
        "Raises InputError if a name to ignore was met in none of what was read.");
}

}  // namespace

void bind_model(py::module_& m) {
  bind_documents(m);
  bind_bodies(m);
  bind_vehicle(m);
  bind_world(m);
  bind_readers(m);
}

}  // namespace quadcore::bindings
