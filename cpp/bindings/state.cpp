#include "state.hpp"

#include <pybind11/numpy.h>

#include <memory>
#include <string>

#include "arguments.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore::bindings {
namespace {

/// Call f(name, data, size) for each vector of a state.
template <class Function>
void for_each_vector(const VehicleState& s, const Function& f) {
  f("position", s.position.data(), 3);
  f("orientation", s.orientation.coeffs().data(), 4);
  f("linear_velocity", s.linear_velocity.data(), 3);
  f("angular_velocity", s.angular_velocity.data(), 3);
  f("rotor_velocity", s.rotor_velocity.data(), s.rotor_velocity.size());
  f("rotor_angle", s.rotor_angle.data(), s.rotor_angle.size());
}

}  // namespace

py::dict views(const Self& self) {
  const std::shared_ptr<Guarded>& guarded = self.guarded;
  py::dict result;
  const auto view = [&](const char* name, const double* data, Eigen::Index size) {
    const py::capsule owner(new std::shared_ptr<Guarded>(guarded), [](void* share) {
      delete static_cast<std::shared_ptr<Guarded>*>(share);
    });
    py::array_t<double> array(static_cast<py::ssize_t>(size), data, owner);
    array.attr("flags").attr("writeable") = false;
    result[name] = array;
  };
  view("time", &guarded->simulation.state().time, 1);
  for_each_vector(guarded->simulation.state(), view);
  result["copy"] = py::cpp_function([guarded] {
    const Lock lock(*guarded);
    return copies(guarded->simulation.state());
  });
  return result;
}

py::dict copies(const VehicleState& state) {
  py::dict result;
  result["time"] = state.time;
  for_each_vector(state, [&](const char* name, const double* data, Eigen::Index size) {
    result[name] = py::array_t<double>(static_cast<py::ssize_t>(size), data);
  });
  return result;
}

VehicleState to_state(const py::object& object) {
  const auto member = [&object](const char* name, int dimensions) {
    py::object given;
    try {
      given = object.attr(name);
    } catch (const py::error_already_set& error) {
      if (!error.matches(PyExc_AttributeError)) throw;
      throw InputError(std::string("the state has no member ") + name + ". Give a State.");
    }
    return numbers(given, dimensions, (std::string("state.") + name).c_str());
  };
  const auto vector = [&member](const char* name) -> VectorXd {
    const Numbers array = member(name, 1);
    return Eigen::Map<const VectorXd>(array.data(), array.size());
  };
  const auto sized = [&vector](const char* name, Eigen::Index size) -> VectorXd {
    VectorXd v = vector(name);
    if (v.size() != size) {
      throw InputError(std::string("state.") + name + " has " + std::to_string(v.size()) +
                       " numbers. Give " + std::to_string(size) + ".");
    }
    return v;
  };
  VehicleState state;
  state.time = *member("time", 0).data();
  state.position = sized("position", 3);
  state.orientation.coeffs() = sized("orientation", 4);
  state.linear_velocity = sized("linear_velocity", 3);
  state.angular_velocity = sized("angular_velocity", 3);
  state.rotor_velocity = vector("rotor_velocity");
  state.rotor_angle = vector("rotor_angle");
  return state;
}

}  // namespace quadcore::bindings
