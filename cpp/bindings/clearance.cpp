#include "quadcore/clearance.hpp"

#include <pybind11/numpy.h>

#include <algorithm>

#include "arguments.hpp"
#include "bindings.hpp"
#include "built.hpp"

namespace quadcore::bindings {
namespace {

Clearance::FramePose frame_pose(const double* row) {
  return {{row[0], row[1], row[2]}, Quaterniond(row[6], row[3], row[4], row[5]).normalized()};
}

py::tuple find_clearance(const Built<Model>& model, const Built<World>& world,
                         const ArrayLike& given) {
  const Numbers poses = numbers(given, 2, "poses");
  const py::ssize_t n = poses.shape(0);
  check_shape(poses, {n, 7}, "poses");
  py::array_t<double> distances(n);
  py::array_t<std::int64_t> indices(n);
  const Clearance clearance(*model, *world);
  for (py::ssize_t i = 0; i < n; ++i) {
    const Clearance::FramePose pose = frame_pose(poses.data(i, 0));
    const Clearance::Nearest nearest = clearance.find(pose.position_W, pose.orientation_W);
    distances.mutable_at(i) = nearest.distance;
    indices.mutable_at(i) = static_cast<std::int64_t>(nearest.obstacle);
  }
  return py::make_tuple(distances, indices);
}

py::array_t<double> find_distance(const Built<Model>& model, const Built<Model>& other,
                                  const ArrayLike& given, const ArrayLike& given_others,
                                  double known, double touching) {
  const Numbers poses = numbers(given, 2, "poses"), others = numbers(given_others, 2, "others");
  const py::ssize_t n = poses.shape(0);
  check_shape(poses, {n, 7}, "poses");
  check_shape(others, {n, 7}, "others");
  const Clearance own(*model, World()), of_other(*other, World());
  py::array_t<double> distances(n);
  for (py::ssize_t i = 0; i < n; ++i) {
    const double distance =
        own.distance_between_vehicles(of_other, frame_pose(poses.data(i, 0)),
                                      frame_pose(others.data(i, 0)), std::max(known, touching));
    distances.mutable_at(i) = distance;
    known = std::min(known, distance);
  }
  return distances;
}

}  // namespace

void bind_clearance(py::module_& m) {
  m.def("find_clearance", &find_clearance, py::arg("model"), py::arg("world"), py::arg("poses"),
        R"(Find the obstacle of the world that is nearest to a vehicle.

Parameters
----------
model, world : Model, World
    Vehicle, and world with its obstacles.
poses : array_like
    Positions (m) and orientations (x, y, z, w) of the frame in the world; shape (n, 7).

Returns
-------
distances : ndarray
    Distance of the nearest obstacle, m; 0 if shapes overlap, infinite without obstacles; shape (n,).
indices : ndarray
    Index of that obstacle in `World.obstacles`; shape (n,).)");
  m.def("find_distance", &find_distance, py::arg("model"), py::arg("other"), py::arg("poses"),
        py::arg("others"), py::arg("known"), py::arg("touching"),
        R"(Find the minimum distance of the collision shapes of two vehicles.

Parameters
----------
model, other : Model
    Vehicles.
poses, others : array_like
    Positions (m) and orientations (x, y, z, w) of their frames in the world; shape (n, 7).
known : float
    Minimum so far, m.
touching : float
    Distance below which every row is exact, m.

Returns
-------
distances : ndarray
    Distance of each row, m; 0 if shapes overlap. A row that is neither below `touching` nor nearer
    than `known` and all rows before has a value that is not below these; shape (n,).)");
}

}  // namespace quadcore::bindings
