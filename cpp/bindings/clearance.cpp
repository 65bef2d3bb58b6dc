#include "quadcore/clearance.hpp"

#include <pybind11/numpy.h>

#include "arguments.hpp"
#include "bindings.hpp"
#include "built.hpp"

namespace quadcore::bindings {
namespace {

py::tuple find_clearance(const Built<Model>& model, const Built<World>& world,
                         const ArrayLike& given) {
  const Numbers poses = numbers(given, 2, "poses");
  const py::ssize_t n = poses.shape(0);
  check_shape(poses, {n, 7}, "poses");
  py::array_t<double> distances(n);
  py::array_t<std::int64_t> indices(n);
  const Clearance clearance(*model, *world);
  for (py::ssize_t i = 0; i < n; ++i) {
    const double* row = poses.data(i, 0);
    const Quaterniond orientation(row[6], row[3], row[4], row[5]);
    const Clearance::Nearest nearest =
        clearance.find({row[0], row[1], row[2]}, orientation.normalized());
    distances.mutable_at(i) = nearest.distance;
    indices.mutable_at(i) = static_cast<std::int64_t>(nearest.obstacle);
  }
  return py::make_tuple(distances, indices);
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
}

}  // namespace quadcore::bindings
