#include "gazebo_physics.hpp"

#include <cmath>
#include <string>

#include "messages.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore::node {
namespace {

gazebo_msgs::ODEPhysics describe_solver(const World& world) {
  gazebo_msgs::ODEPhysics solver;
  solver.sor_pgs_iters = static_cast<std::uint32_t>(world.solver_iterations);
  solver.sor_pgs_w = world.solver_sor;
  solver.cfm = world.cfm;
  solver.erp = world.erp;
  solver.contact_max_correcting_vel = world.contact_max_correcting_vel;
  // The values of Gazebo 11, which the engine gazebo11 repeats.
  solver.contact_surface_layer = 0.001;
  solver.max_contacts = static_cast<std::uint32_t>(world.max_contacts);
  return solver;
}

void check_same(bool same, const std::string& what, const std::string& instead) {
  if (!same) throw InputError(what + " cannot be changed during a flight. " + instead);
}

}  // namespace

void describe_physics(const Simulation& simulation, const FlightReport& report,
                      gazebo_msgs::GetPhysicsProperties::Response& response) {
  response.time_step = simulation.dt();
  response.pause = report.paused;
  response.max_update_rate = report.real_time_factor / simulation.dt();
  set_vector(response.gravity, simulation.world().gravity_W.data());
  response.ode_config = describe_solver(simulation.world());
}

void check_physics(const Simulation& simulation,
                   const gazebo_msgs::SetPhysicsProperties::Request& request) {
  const World& world = simulation.world();
  check_same(request.time_step == simulation.dt(), "time_step", "Start with dt:=.");
  check_same(vector_of(request.gravity) == world.gravity_W, "gravity",
             "Start with another world:=.");
  gazebo_msgs::ODEPhysics now = describe_solver(world);
  const gazebo_msgs::ODEPhysics& wanted = request.ode_config;
  const bool same = wanted.sor_pgs_iters == now.sor_pgs_iters &&
                    wanted.sor_pgs_precon_iters == now.sor_pgs_precon_iters &&
                    wanted.sor_pgs_w == now.sor_pgs_w && wanted.cfm == now.cfm &&
                    wanted.sor_pgs_rms_error_tol == now.sor_pgs_rms_error_tol &&
                    wanted.erp == now.erp && wanted.max_contacts == now.max_contacts &&
                    wanted.contact_surface_layer == now.contact_surface_layer &&
                    wanted.contact_max_correcting_vel == now.contact_max_correcting_vel &&
                    wanted.auto_disable_bodies == now.auto_disable_bodies;
  check_same(same, "ode_config", "Start with a world:= that has these values.");
  if (!(request.max_update_rate >= 0 && std::isfinite(request.max_update_rate))) {
    throw InputError("max_update_rate is not valid. Give a number >= 0; 0 is as fast as possible.");
  }
}

double compute_real_time_factor(const gazebo_msgs::SetPhysicsProperties::Request& request) {
  return request.max_update_rate * request.time_step;
}

}  // namespace quadcore::node
