#include "bindings.hpp"

PYBIND11_MODULE(_core, m) {
  m.doc() = "C++ core of quadcore; use the package quadcore instead.";
  quadcore::bindings::bind_errors(m);
  quadcore::bindings::bind_document(m);
  quadcore::bindings::bind_model(m);
  quadcore::bindings::bind_world(m);
  quadcore::bindings::bind_clearance(m);
  quadcore::bindings::bind_plugins(m);
  quadcore::bindings::bind_snapshot(m);
  quadcore::bindings::bind_simulation(m);
  quadcore::bindings::bind_batch(m);
  quadcore::bindings::bind_flight(m);
  quadcore::bindings::bind_fleet(m);
  quadcore::bindings::bind_reference(m);
  quadcore::bindings::bind_odometry(m);
  quadcore::bindings::bind_control(m);
  quadcore::bindings::bind_control_loop(m);
  quadcore::bindings::guard_classes(m);
}
