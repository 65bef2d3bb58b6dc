#include "quadcore/plugin/model.hpp"

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "arguments.hpp"
#include "bindings.hpp"
#include "built.hpp"
#include "quadcore/drawing.hpp"
#include "quadcore/gazebo_reference.hpp"
#include "quadcore/harmless_elements.hpp"
#include "quadcore/plugin/document.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/plugin/world.hpp"
#include "quadcore/text.hpp"
#include "unpickled.hpp"

namespace quadcore::bindings {
namespace {

/// Version of the pickle format of models and worlds.
constexpr int version = 1;

const Source& source_of(const std::shared_ptr<const Source>& source) {
  if (!source) {
    throw InputError("this model was rounded by its engine. Pickle the model that was read.");
  }
  return *source;
}

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

/// Pickle the document and read it again, so that the pickle contains neither paths nor
/// inconsistent data.
template <class Read>
auto by_document(Read (*read)(const Document&, const std::vector<std::string>&)) {
  return py::pickle(
      [](const Built<Read>& held) -> py::object {
        const auto& [document, ignore] = source_of(held->source);
        return py::make_tuple(version, document.name, document.text, document.lines, ignore);
      },
      [read](const py::object& state) {
        return unpickled("the model or world", "Read", [&] {
          if (py::cast<int>(state[py::int_(0)]) != version) throw OtherVersion();
          return std::make_shared<Read>(read(
              {py::cast<std::string>(state[py::int_(1)]), py::cast<std::string>(state[py::int_(2)]),
               py::cast<std::vector<std::pair<std::string, int>>>(state[py::int_(3)])},
              py::cast<std::vector<std::string>>(state[py::int_(4)])));
        });
      });
}

/// Return a getter of a member of a model or world.
template <class T, class Member>
auto get(Member T::* member) {
  return [member](const Built<T>& built) -> Member { return (*built).*member; };
}

/// Return the document from which a model or world was read.
template <class T>
Document get_document(const Built<T>& built) {
  return source_of(built->source).document;
}

void bind_documents(py::module_& m) {
  py::class_<Document>(m, "Document", R"(An XML text and where its lines came from.

Attributes
----------
largest, largest_world : int
    Bytes that a text may have, and the text of a world.
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
      .def_readonly("name", &Document::name, "File name for error messages.")
      .def_readonly("text", &Document::text, "XML text.")
      .def_readonly("lines", &Document::lines,
                    "Source file and line of each line of an expanded text; empty if the text is "
                    "the file itself.")
      .def_property_readonly_static("largest", [](const py::object&) { return Document::largest; })
      .def_property_readonly_static("largest_world",
                                    [](const py::object&) { return Document::largest_world; })
      .def_property_readonly_static("most_levels",
                                    [](const py::object&) { return Document::most_levels; })
      .def_property_readonly_static("most_attributes",
                                    [](const py::object&) { return Document::most_attributes; });

  py::class_<IgnoredElements>(m, "IgnoredElements", "Elements that a reader found but did not use.")
      .def_property_readonly("ignored", &IgnoredElements::ignored,
                             "Names of the elements that the user ignored.")
      .def_property_readonly("warning", &IgnoredElements::warning,
                             "Warning about elements without effect on the motion, or \"\".")
      .def_property_readonly(
          "unsimulated", &IgnoredElements::unsimulated,
          "Parts of the world that may affect the motion but are not simulated, list of str.");

  py::class_<HarmlessElement>(m, "HarmlessElement",
                              "Element or module without effect on the motion.")
      .def_readonly("name", &HarmlessElement::name,
                    "Name of the element, or file name of the module.")
      .def_readonly("parent", &HarmlessElement::parent,
                    "Parent element, such as \"robot/link\"; \"\" for a module.")
      .def_readonly("what", &HarmlessElement::what,
                    "Purpose of the element, or output of the module.");
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

const char* kind_name(const Obstacle& obstacle) {
  switch (obstacle.kind) {
    case ShapeKind::box:
      return "box";
    case ShapeKind::cylinder:
      return "cylinder";
    case ShapeKind::sphere:
      return "sphere";
    case ShapeKind::mesh:
      return "mesh";
    case ShapeKind::plane:
      break;
  }
  return "plane";
}

void bind_obstacle(py::module_& m) {
  py::class_<Obstacle>(m, "Obstacle", "Collision shape of a world that stands still.")
      .def_readonly("model", &Obstacle::model, "Name of its model.")
      .def_readonly("name", &Obstacle::name, "LINK::COLLISION.")
      .def_property_readonly("kind", &kind_name, "box, cylinder, sphere, plane or mesh.")
      .def_property_readonly(
          "size", [](const Obstacle& o) -> Vector3d { return o.size; },
          "Box x, y, z; cylinder radius, length; sphere radius; extent of a mesh, m; plane: "
          "normal; "
          "shape (3,).")
      .def_property_readonly(
          "position", [](const Obstacle& o) -> Vector3d { return o.position_W; },
          "Position in the world, m; shape (3,). Only z of a plane has an effect.")
      .def_property_readonly(
          "orientation",
          [](const Obstacle& o) -> Eigen::Vector4d { return o.orientation_W.coeffs(); },
          "Orientation in the world, x, y, z, w; shape (4,).")
      .def_readonly("where", &Obstacle::where, "FILE:LINE.")
      .def("distance_to", &distance_to, py::arg("point"),
           "Return the signed distance of a point (3,) from the surface, negative inside, m. That "
           "of a mesh has no sign.")
      .def_property_readonly(
          "vertices",
          [](const Obstacle& o) {
            Eigen::Matrix<double, Eigen::Dynamic, 3> vertices(o.mesh ? o.mesh->vertices.size() : 0,
                                                              3);
            for (Eigen::Index i = 0; i < vertices.rows(); ++i) {
              vertices.row(i) = o.mesh->vertices[static_cast<std::size_t>(i)].cast<double>();
            }
            return vertices;
          },
          "Vertices of a mesh in its axes, m; shape (n, 3).")
      .def_property_readonly(
          "triangles",
          [](const Obstacle& o) {
            Eigen::Matrix<std::uint32_t, Eigen::Dynamic, 3> triangles(
                o.mesh ? o.mesh->triangles.size() : 0, 3);
            for (Eigen::Index i = 0; i < triangles.rows(); ++i) {
              const auto& triangle = o.mesh->triangles[static_cast<std::size_t>(i)];
              triangles.row(i) << triangle[0], triangle[1], triangle[2];
            }
            return triangles;
          },
          "Vertices of each triangle of a mesh, indices; shape (n, 3).");
}

void bind_free_bodies(py::module_& m) {
  py::class_<FreeBody>(m, "FreeBody", "Link of a world's model that is not static.")
      .def_readonly("model", &FreeBody::model, "Name of its model.")
      .def_readonly("name", &FreeBody::name, "Name of the link.")
      .def_property_readonly(
          "mass", [](const FreeBody& b) { return b.inertial.mass; }, "Mass, kg.")
      .def_readonly("shapes", &FreeBody::shapes,
                    "Its collision shapes at the start, list of Obstacle.")
      .def_readonly("where", &FreeBody::where, "FILE:LINE.");
  py::class_<FreeBodyState>(m, "FreeBodyState", "Motion of a free body.")
      .def_readonly("name", &FreeBodyState::name, "MODEL::LINK.")
      .def_property_readonly(
          "position", [](const FreeBodyState& s) -> Vector3d { return s.position_W; },
          "Position of the link in the world, m; shape (3,).")
      .def_property_readonly(
          "orientation",
          [](const FreeBodyState& s) -> Eigen::Vector4d { return s.orientation_W.coeffs(); },
          "Orientation in the world, x, y, z, w; shape (4,).")
      .def_property_readonly(
          "linear_velocity", [](const FreeBodyState& s) -> Vector3d { return s.linear_velocity_W; },
          "Velocity of the link's origin in world axes, m/s; shape (3,).")
      .def_property_readonly(
          "angular_velocity",
          [](const FreeBodyState& s) -> Vector3d { return s.angular_velocity_W; },
          "Angular velocity in world axes, rad/s; shape (3,).");
}

void bind_world(py::module_& m) {
  py::class_<World, std::shared_ptr<World>>(m, "World", "Settings of a world file.")
      .def_property_readonly("gravity", get(&World::gravity_W),
                             "Gravity in world axes, m/s^2; shape (3,).")
      .def_property_readonly("wind", get(&World::wind_W),
                             "Velocity of the air in world axes, m/s; shape (3,).")
      .def_property_readonly("magnetic_field", get(&World::magnetic_field_W),
                             "Magnetic field in world axes (x east, y north, z up), T; shape (3,).")
      .def_property_readonly("max_step_size", get(&World::max_step_size),
                             "Default time step of a simulation, s.")
      .def_property_readonly(
          "real_time_update_rate", get(&World::real_time_update_rate),
          "Steps per second of wall-clock time for nodes in real time; 0: as fast as possible.")
      .def_property_readonly("ground_plane", get(&World::ground_plane),
                             "Whether there is a ground plane at z = 0.")
      .def_property_readonly("obstacles", get(&World::obstacles),
                             "Obstacles other than that ground plane, a list of Obstacle.")
      .def_property_readonly("free_bodies", get(&World::free_bodies),
                             "Links of models that are not static, a list of FreeBody.")
      .def_property_readonly("start_time", get(&World::start_time),
                             "Time at which a saved world starts (s).")
      .def_property_readonly("ignored_models", get(&World::ignored_models),
                             "Models that are ignored on request, though they may be obstacles.")
      .def_property_readonly("ignored_elements", get(&World::ignored_elements),
                             "Elements that the reader ignored.")
      .def_property_readonly("document", &get_document<World>,
                             "Document from which the world was read.")
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
        "Return the finite number in a text, as in a URDF, or None.");
  py::class_<GazeboTag>(m, "GazeboTag", "Tag of a <gazebo reference>.")
      .def_readonly("name", &GazeboTag::name, "Name of the tag.")
      .def_readonly("of", &GazeboTag::of,
                    "Kind of element that the reference must name: link or joint.")
      .def_readonly("affects", &GazeboTag::affects,
                    "Objects that the tag affects: shapes, body or joint; \"\" for none.")
      .def_readonly("unit", &GazeboTag::unit, "Unit, or \"\".")
      .def_readonly("default", &GazeboTag::fallback, "Default value, or \"\".")
      .def_readonly("range", &GazeboTag::range, "Valid values as readable text.")
      .def_readonly("meaning", &GazeboTag::meaning, "Meaning in one line.");
  m.def("gazebo_tags", &gazebo_tags,
        "Return all tags of <gazebo reference>, those with an effect first.");
  m.def("world_elements", &world_elements,
        "Return the elements of a world file, named by their paths below <world>.");
  m.def("list_harmless_elements", &list_harmless_elements,
        "Return the known elements and modules without effect on the motion.");

  const auto nothing = std::vector<std::string>{};
  m.def("read_model", &read_model, py::arg("document"), py::arg("ignore") = nothing,
        "Read a URDF as Gazebo does, with fixed links lumped. Raises InputError with FILE:LINE.");
  m.def("read_world", &read_world, py::arg("document"), py::arg("ignore") = nothing,
        "Read a world file. Raises InputError with FILE:LINE.");
  m.def("check_ignored", &check_ignored, py::arg("ignore"), py::arg("readings"),
        "Raise InputError if a name to ignore was found in none of the documents.");
}

}  // namespace

void bind_model(py::module_& m) {
  bind_documents(m);
  bind_bodies(m);
  bind_vehicle(m);
  bind_obstacle(m);
  bind_free_bodies(m);
  bind_world(m);
  bind_readers(m);
}

}  // namespace quadcore::bindings
