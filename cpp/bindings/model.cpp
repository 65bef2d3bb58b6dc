#include "quadcore/plugin/model.hpp"

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "arguments.hpp"
#include "bindings.hpp"
#include "quadcore/drawing.hpp"
#include "read_from_document.hpp"

namespace quadcore::bindings {
namespace {

using Places = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// Return in row i the origin of joint i's child link from the frame's, frame axes [m].
Places joint_places(const Model& model) {
  const std::vector<Eigen::Isometry3d> poses = link_poses(model);
  Places places(static_cast<Eigen::Index>(model.joints.size()), 3);
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    places.row(static_cast<Eigen::Index>(i)) = poses[i + 1].translation();
  }
  return places;
}

/// Return the corners; corner i is on the far side along axis k of the box if bit k of i is set
/// [m].
py::array_t<double> corners_of_box(const Link& link) {
  const InertiaBox box = inertia_box(link.inertial);
  Eigen::Matrix<double, 8, 3, Eigen::RowMajor> corners;
  for (int i = 0; i < 8; ++i) {
    const Vector3d sides((i & 1) - 0.5, (i >> 1 & 1) - 0.5, (i >> 2 & 1) - 0.5);
    corners.row(i) = box.center + box.orientation * sides.cwiseProduct(box.edges);
  }
  return py::cast(corners);
}

/// Return the pose of each link in the frame as a homogeneous matrix [m].
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

void bind_bodies(py::module_& m) {
  py::class_<Collision>(m, "Collision", "Shape that can touch the ground.")
      .def_readonly("where", &Collision::where, "FILE:LINE.")
      .def_property_readonly(
          "size", [](const Collision& c) -> Vector3d { return c.size; },
          "Box x, y, z; cylinder radius, length, 0; sphere radius, 0, 0; m, shape (3,).")
      .def_property_readonly(
          "xyz", [](const Collision& c) -> Vector3d { return c.pose.xyz; },
          "Position in the link's axes, m; shape (3,).")
      .def_property_readonly(
          "rpy", [](const Collision& c) -> Vector3d { return c.pose.rpy; },
          "Roll, pitch and yaw in the link, rad; shape (3,).");

  py::class_<Link>(m, "Link", "Moving body: a link and all links fixed to it.")
      .def_readonly("name", &Link::name, "Name of the link that carries the fixed links.")
      .def_readonly("where", &Link::where, "FILE:LINE.")
      .def_property_readonly(
          "mass", [](const Link& link) { return link.inertial.mass; }, "kg.")
      .def_property_readonly(
          "center_of_mass", [](const Link& link) -> Vector3d { return link.inertial.pose.xyz; },
          "Centre of mass in the link's axes, m; shape (3,).")
      .def_property_readonly(
          "inertia", [](const Link& link) { return link.inertial.inertia_in_link_axes(); },
          "Inertia about the centre of mass, link axes, kg m^2; shape (3, 3).")
      .def_property_readonly("inertia_box", &corners_of_box,
                             "Corners of the equivalent inertia box, which is homogeneous and has "
                             "the same mass and inertia, in the link's axes, m; shape (8, 3).")
      .def("__repr__",
           [](const Link& link) {
             return py::str("<Link '{}', {:.6g} kg>").format(text(link.name), link.inertial.mass);
           })
      .def_readonly("collisions", &Link::collisions,
                    "Shapes that can touch the ground, list of Collision.");

  py::class_<Joint>(m, "Joint", "Continuous joint.")
      .def("__repr__",
           [](const Joint& joint) { return py::str("<Joint '{}'>").format(text(joint.name)); })
      .def_readonly("name", &Joint::name, "Name of the joint.")
      .def_readonly("where", &Joint::where, "FILE:LINE.")
      .def_readonly("damping", &Joint::damping, "Damping, N m s/rad.")
      .def_property_readonly(
          "axis", [](const Joint& joint) -> Vector3d { return joint.axis; },
          "Unit vector of the axis in the child link's axes; the right-hand rule gives the "
          "positive direction of rotation; shape (3,).")
      .def_property_readonly(
          "xyz", [](const Joint& joint) -> Vector3d { return joint.pose.xyz; },
          "Origin of the child link in the parent link, m; shape (3,).")
      .def_property_readonly(
          "rpy", [](const Joint& joint) -> Vector3d { return joint.pose.rpy; },
          "Roll, pitch and yaw of the child link in the parent link at angle zero, rad; shape "
          "(3,).");
}

void bind_vehicle(py::module_& m) {
  py::class_<Model, std::shared_ptr<Model>>(m, "Model", "Vehicle with bodies, joints and plugins.")
      .def_property_readonly("name", get(&Model::name), "Name of the robot.")
      .def_property_readonly("links", get(&Model::links),
                             "Bodies, list of Link: the frame, then the child link of each joint.")
      .def_property_readonly("joints", get(&Model::joints),
                             "Continuous joints in file order, list of Joint.")
      .def_property_readonly(
          "link_poses", [](const Built<Model>& held) { return poses_of_links(*held); },
          "Pose of each of `links` in the frame with all joints at angle zero: homogeneous "
          "matrices, m; shape (n + 1, 4, 4).")
      .def_property_readonly(
          "drawn_disc_radius", [](const Built<Model>& held) { return drawn_disc_radius(*held); },
          "Radius of the rotor discs in plots, such that none overlaps another, m.")
      .def_property_readonly(
          "joint_places", [](const Built<Model>& held) { return joint_places(*held); },
          "Origin of each joint's child link relative to the frame's, frame axes, all joints at "
          "angle zero, m; shape (n, 3).")
      .def_property_readonly("warnings", get(&Model::warnings),
                             "Warnings about valid but suspicious input, list of str.")
      .def_property_readonly("ignored_elements", get(&Model::ignored_elements),
                             "Elements that the reader ignored.")
      .def_property_readonly("document", &get_document<Model>,
                             "Document from which the model was read.")
      .def("__repr__",
           [](const Built<Model>& held) {
             return py::str("<Model '{}', {:.6g} kg, {} rotors>")
                 .format(text(held->name), mass_properties(*held).mass, held->joints.size());
           })
      .def(by_document(&read_model));
}

}  // namespace

void bind_model(py::module_& m) {
  bind_bodies(m);
  bind_vehicle(m);
  m.def("read_model", &read_model, py::arg("document"),
        py::arg("ignore") = std::vector<std::string>{},
        "Read a URDF as Gazebo does, with fixed links lumped. Raises InputError with FILE:LINE.");
}

}  // namespace quadcore::bindings
