#include "quadcore/plugin/world.hpp"

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "bindings.hpp"
#include "read_from_document.hpp"

namespace quadcore::bindings {
namespace {

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

void bind_settings(py::module_& m) {
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

}  // namespace

void bind_world(py::module_& m) {
  bind_obstacle(m);
  bind_free_bodies(m);
  bind_settings(m);
  m.def("read_world", &read_world, py::arg("document"),
        py::arg("ignore") = std::vector<std::string>{},
        "Read a world file. Raises InputError with FILE:LINE.");
}

}  // namespace quadcore::bindings
