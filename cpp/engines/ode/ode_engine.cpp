#include "ode_engine.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

#include "beside_contact.hpp"
#include "body_state.hpp"
#include "ode_process.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/plugin/random.hpp"
#include "sdf_conversion.hpp"

namespace quadcore {

const OdeRecipe gazebo11_recipe{true, &add_gyroscopic_per_body};
const OdeRecipe ode_recipe{false, &add_gyroscopic_from_carrier};

namespace {

/// Maximum fraction of an error that remains after the sweeps of a step, for which the much faster
/// direct solution replaces them. Flights of 10 s differ by 4e-10 m for 7e-11 and by 0.4 mm for
/// 1e-5. If 50 sweeps do not converge, a larger fraction remains.
constexpr double converged = 1e-14;
/// Number of attitudes for the convergence test, which depends slightly on them.
constexpr std::uint64_t tried_attitudes = 8;

/// Limit of a hinge's correction in the solution for velocities [m/s, rad/s].
double max_hinge_correction(const World& world, const OdeRecipe& recipe) {
  return recipe.like_gazebo ? world.contact_max_correcting_vel : dInfinity;
}

}  // namespace

GazeboStep::Options gazebo_options(const World& world, const OdeRecipe& recipe,
                                   std::vector<GazeboStep::Damping> damping) {
  return {world.solver_iterations,
          world.solver_sor,
          world.gravity_W,
          {world.erp, world.cfm, max_hinge_correction(world, recipe)},
          std::move(damping)};
}

bool is_clear_of_contact(const std::vector<double>& saved) {
  return saved.back() >= steps_beside_contact;
}

OdeEngine::OdeEngine(const Model& model, const World& world, const OdeRecipe& recipe)
    : model_(recipe.like_gazebo ? converted_to_sdf(model) : model),
      bodies_(recipe.like_gazebo ? sdf_bodies(model) : Bodies(model)),
      recipe_(recipe),
      warnings_(recipe.like_gazebo ? bodies_.model.warnings : std::vector<std::string>()),
      hinged_(bodies_, world, max_hinge_correction(world, recipe)),
      steps_since_contact_(steps_beside_contact),
      kinematics_(model.joints.size(), true),
      loads_(model.joints.size()) {
  start_ode();
  world_.reset(dWorldCreate());
  take_threading();
  dWorldSetGravity(world_.get(), world.gravity_W.x(), world.gravity_W.y(), world.gravity_W.z());
  dWorldSetERP(world_.get(), world.erp);
  dWorldSetCFM(world_.get(), world.cfm);
  vehicle_ = std::make_unique<OdeVehicle>(bodies_, world_.get());
  const std::vector<dBodyID>& bodies = vehicle_->bodies();
  gyroscopic_ = std::make_unique<GyroscopicVehicle>(bodies_.model, bodies);
  free_ = std::make_unique<FreeBodies>(world);
  all_bodies_ = bodies;
  all_bodies_.insert(all_bodies_.end(), free_->bodies().begin(), free_->bodies().end());
  create_step(world);
  if (world.ground_plane || !world.obstacles.empty() || !free_->empty()) {
    contact_ = std::make_unique<WorldContact>(std::vector<const Model*>{&bodies_.model},
                                              all_bodies_, world);
    gazebo_step_->reserve(contact_->most_on_ground());
    expect_contact();
  }
  for (std::size_t i = 0; i < model_.joints.size(); ++i) {
    kinematics_.rotors.set_matrix(MotionRow::R_FR_at_zero, i,
                                  model_.joints[i].pose.rotation().toRotationMatrix());
  }
  gravity_z_ = world.gravity_W.z();
  choose_method(world);
}

/// Create the sweeps over all bodies. The free ones are the older ones.
void OdeEngine::create_step(const World& world) {
  std::vector<Hinge> hinges = vehicle_->hinge_rows();
  for (const Hinge& hinge : hinges) rubs_ |= hinge.friction > 0;
  const std::size_t vehicle = vehicle_->bodies().size();
  const std::vector<Hinge> joints = free_->hinge_rows(vehicle);
  hinges.insert(hinges.end(), joints.begin(), joints.end());
  std::vector<GazeboStep::Damping> damping;
  for (const Link& link : bodies_.model.links) {
    damping.push_back({link.tags.damping_factor, link.tags.damping_factor});
  }
  for (const GazeboStep::Damping& of_free : free_->damping()) damping.push_back(of_free);
  std::vector<std::size_t> order(free_->bodies().size());
  std::iota(order.begin(), order.end(), vehicle);
  for (const std::size_t body : sdf_order(bodies_.model)) order.push_back(body);
  gazebo_step_ =
      std::make_unique<GazeboStep>(all_bodies_, std::move(hinges), order,
                                   gazebo_options(world, recipe_, std::move(damping)), vehicle);
}

/// Decide once whether to use the world's sweeps in flight.
void OdeEngine::choose_method(const World& world) {
  std::ostringstream method;
  const bool quick = world.solver_type == "quick";
  if (recipe_.like_gazebo && quick) {
    const double remaining = remaining_error(world.max_step_size);
    iterate_ = remaining > converged;
    method.precision(2);
    method << "in flight ";
    if (iterate_) {
      method << world.solver_iterations << " iterations of Gazebo's solver, which leave "
             << remaining << " of an error of the hinge forces per step";
    } else {
      method << "the solution of ODE's direct solver, to which Gazebo's " << world.solver_iterations
             << " iterations converge";
    }
  } else {
    method << "in flight the solution of ODE's direct solver";
  }
  if (contact_)
    method << (world.obstacles.empty() && free_->empty() ? "; on the ground " : "; in contact ")
           << world.solver_iterations << " iterations of Gazebo's solver";
  method_ = method.str();
  may_float_ = recipe_.like_gazebo && !iterate_ && !rubs_;
  for (const Link& link : bodies_.model.links) may_float_ &= link.tags.damping_factor == 0;
  if (contact_ && !quick) {
    warnings_.push_back(world.solver_type_where +
                        ": the solver type world fails on the ground in Gazebo, so quick is used "
                        "there. Write quick.");
  }
  VehicleState rest;
  rest.rotor_velocity = rest.rotor_angle =
      VectorXd::Zero(static_cast<Eigen::Index>(vehicle_->rotors()));
  set_state(rest);
}

/// Return the maximum over some attitudes.
double OdeEngine::remaining_error(double dt) {
  double largest = 0;
  for (std::uint64_t seed = 0; seed < tried_attitudes; ++seed) {
    double count = 0;
    VehicleState state;
    for (int i = 0; i < 4; ++i) state.orientation.coeffs()[i] = random_normal(seed, count);
    const auto n = static_cast<Eigen::Index>(vehicle_->rotors());
    state.rotor_velocity = state.rotor_angle = VectorXd::Zero(n);
    for (Eigen::Index i = 0; i < n; ++i) state.rotor_angle[i] = random_normal(seed, count);
    set_state(state);
    largest = std::max(largest, gazebo_step_->remaining_error(dt, seed, converged));
  }
  return largest;
}

void OdeEngine::take_threading() {
  threading_.reset(dThreadingAllocateSelfThreadedImplementation());
  dWorldSetStepThreadingImplementation(
      world_.get(), dThreadingImplementationGetFunctions(threading_.get()), threading_.get());
}

void OdeEngine::expect_contact() {
  may_touch_ = true;
  if (rubs_) vehicle_->report_hinge_forces();
}

void OdeEngine::step(double time, double dt, const ForceField& forces) {
  if (float_by_laws(dt, forces.laws())) return;
  evaluate(time, forces);
  move(dt, false);
}

/// Take a step in flight with laws that the lanes evaluate themselves. Returns false without a
/// motion if there are other forces, or if the step requires more than that.
bool OdeEngine::float_by_laws(double dt, const ForceLaws& laws) {
  // The order of several laws on the frame is that of their plugins.
  if (!laws.complete || laws.frame_drags.size() > 1 || laws.airframes.size() > 1) return false;
  return is_afloat(dt) && hinged_.push(views_of(laws), kinematics_) && float_on(dt);
}

void OdeEngine::evaluate(double time, const ForceField& forces) {
  kinematics_.time = time;
  loads_.clear();
  forces.evaluate(kinematics_, loads_);
  if (!loads_.all_finite()) forces.refuse(kinematics_, loads_);  // ODE would end the process
}

void OdeEngine::move(double dt, bool near) {
  if (!near && is_afloat(dt)) {
    hinged_.push(loads_);
    if (float_on(dt)) return;
  }
  step_in_ode(dt, near);
  hinged_.show(kinematics_);
}

/// Take a step in flight under the present forces on the vehicle. Returns false without a motion if
/// Gazebo limits the correction of a hinge.
bool OdeEngine::float_on(double dt) {
  if (!hinged_.advance(dt, true)) return false;
  behind_ = true;
  step_free(dt);
  hinged_.show(kinematics_);
  return true;
}

/// Return whether this step does not require the bodies in ODE.
bool OdeEngine::is_afloat(double dt) const {
  if (!may_float_ || loads_.any_rate()) return false;
  if (steps_since_contact_ < steps_beside_contact) return false;
  if (!contact_) return true;
  const double time = steps_beside_contact * dt;
  if (!contact_->is_clear(hinged_.position(), hinged_.velocity(), time)) return false;
  if (!contact_->has_ground()) return true;
  return std::all_of(contact_->reaches().begin(), contact_->reaches().end(),
                     [&](const Reach& reach) {
                       return hinged_.is_high(reach.body, reach.length, time, gravity_z_);
                     });
}

void OdeEngine::settle() const {
  if (!behind_) return;
  hinged_.give(vehicle_->bodies());
  if (may_touch_) remember_hinge_forces();
  behind_ = false;
}

void OdeEngine::push(double dt) {
  start_ode();
  settle();
  vehicle_->apply(loads_, kinematics_, dt);
  if (loads_.any_rate()) {
    if (recipe_.like_gazebo) {
      vehicle_->turn_like_gazebo(loads_);
    } else {
      vehicle_->turn(loads_);
    }
  }
  recipe_.add_gyroscopic(*gyroscopic_, dt);
}

void OdeEngine::take_motion() {
  steps_since_contact_ = 0;
  hinged_.take(vehicle_->bodies());
  hinged_.show(kinematics_);
}

void OdeEngine::step_in_ode(double dt, bool near) {
  push(dt);
  static const std::vector<Contact> none;
  const std::vector<Contact>& contacts = contact_ ? contact_->find(gazebo_step_->unmoved) : none;
  gazebo_step_->reserve(contacts.size());
  free_->push();
  put_to_sleep(contacts, dt);
  if (iterate_ || is_near_contact(dt, touches_vehicle(contacts), near)) {
    gazebo_step_->step(contacts, dt);
  } else if (solve(dt)) {
    if (may_touch_) remember_hinge_forces();
    vehicle_->damp();
    if (!free_->empty()) gazebo_step_->step_free(contacts, dt);
  } else {
    // Start from zero multipliers, so that the step depends only on pose and velocities, the
    // complete state of vehicles in a batch.
    forget_hinge_forces();
    gazebo_step_->step(contacts, dt);
  }
  hinged_.take(vehicle_->bodies());
}

/// Move the free bodies alone, while the vehicle is far from them.
void OdeEngine::step_free(double dt) {
  const std::vector<char>& asleep = gazebo_step_->asleep;
  const auto first = asleep.begin() + static_cast<std::ptrdiff_t>(vehicle_->bodies().size());
  if (std::all_of(first, asleep.end(), [](char sleeps) { return sleeps != 0; })) return;
  const std::vector<Contact>& contacts = contact_->find_free(gazebo_step_->unmoved);
  gazebo_step_->reserve(contacts.size());
  free_->push();
  put_to_sleep(contacts, dt);
  gazebo_step_->step_free(contacts, dt);
}

void OdeEngine::put_to_sleep(const std::vector<Contact>& contacts, double dt) {
  free_->put_to_sleep(contacts, dt, vehicle_->bodies().size(), gazebo_step_->asleep);
}

bool OdeEngine::touches_vehicle(const std::vector<Contact>& contacts) const {
  const std::size_t vehicle = vehicle_->bodies().size();
  return std::any_of(contacts.begin(), contacts.end(), [&](const Contact& contact) {
    return contact.body < vehicle ||
           (contact.other >= 0 && static_cast<std::size_t>(contact.other) < vehicle);
  });
}

/// Return whether this step has contacts or follows such a step within the limit of Gazebo's
/// sweeps.
bool OdeEngine::is_near_contact(double dt, bool touching, bool near) {
  if (!may_touch_) return false;
  const bool after = steps_since_contact_ < steps_beside_contact;
  steps_since_contact_ = touching ? 0 : std::min(steps_since_contact_ + 1, steps_beside_contact);
  if (touching) return true;
  if (!recipe_.like_gazebo) return false;
  return after || near || (contact_ && contact_->is_ahead(steps_beside_contact * dt));
}

/// Take a step in flight; returns false if Gazebo limits the correction of a hinge. If ODE fails
/// (see start_ode), it leaves jobs and memory of an incomplete step.
bool OdeEngine::solve(double dt) {
  if (!rubs_) {
    const std::vector<dBodyID>& bodies = vehicle_->bodies();
    hinged_.take(bodies);  // their rates may have been prescribed
    hinged_.take_forces(bodies);
    if (!hinged_.advance(dt, false)) return false;
    hinged_.give(bodies);
    return true;
  }
  if (recipe_.like_gazebo && gazebo_step_->caps_hinges(dt)) return false;
  try {
    dWorldStep(world_.get(), dt);
    return true;
  } catch (...) {
    dWorldCleanupWorkingMemory(world_.get());
    threading_.release();  // ODE does not free a job list that is not empty
    take_threading();
    throw;
  }
}

/// Take a step with contacts, which starts from the hinge forces of the previous step.
void OdeEngine::remember_hinge_forces() const {
  const auto remember = [this](std::size_t i, const GazeboStep::Multipliers& multipliers) {
    gazebo_step_->warm_start[i] = {multipliers, multipliers};
  };
  if (!rubs_) return hinged_.for_each_hinge(remember);
  std::size_t rotor = 0;
  for (std::size_t i = 0; i < vehicle_->hinges(); ++i) {
    Matrix3d R_WC = hinged_.R_WB(i + 1);
    // The pose of a rotor is rounded through that of the frame.
    if (!bodies_.is_locked(i)) R_WC = kinematics_.R_WF * kinematics_.R_FR(rotor++);
    remember(i, vehicle_->multipliers(i, R_WC));
  }
}

void OdeEngine::forget_hinge_forces() {
  std::fill_n(gazebo_step_->warm_start.begin(), vehicle_->hinges(), GazeboStep::WarmStart{});
}

/// Write the motion of the bodies in ODE.
void OdeEngine::show() {
  behind_ = false;
  hinged_.take(vehicle_->bodies());
  hinged_.show(kinematics_);
}

void OdeEngine::set_state(const VehicleState& state) {
  vehicle_->place(state);
  forget_hinge_forces();
  steps_since_contact_ = steps_beside_contact;
  show();
}

std::size_t OdeEngine::saved_size() const {
  return vehicle_->bodies().size() * (pose_size + velocity_size) +
         gazebo_step_->warm_start.size() * 2 * rows_per_hinge + free_->saved_size() +
         2 * free_->bodies().size() + 1;
}

std::vector<double> OdeEngine::save() const {
  settle();
  std::vector<double> saved(saved_size());
  double* to = saved.data();
  for (const dBodyID body : vehicle_->bodies()) {
    save_pose(body, to);
    save_velocity(body, to + pose_size);
    to += pose_size + velocity_size;
  }
  for (const GazeboStep::WarmStart& start : gazebo_step_->warm_start) {
    to = std::copy(start.pose.begin(), start.pose.end(), to);
    to = std::copy(start.velocity.begin(), start.velocity.end(), to);
  }
  to = free_->save(to);
  for (std::size_t i = vehicle_->bodies().size(); i < all_bodies_.size(); ++i) {
    *to++ = gazebo_step_->asleep[i];
    *to++ = gazebo_step_->unmoved[i];
  }
  *to = steps_since_contact_;
  return saved;
}

void OdeEngine::restore(const std::vector<double>& saved) {
  if (saved.size() != saved_size()) {
    throw InputError(
        "snapshot: it was taken with another model or engine. Restore a snapshot of this "
        "simulation.");
  }
  const double* from = saved.data();
  for (const dBodyID body : vehicle_->bodies()) {
    forget_forces(body);
    restore_pose(body, from);
    restore_velocity(body, from + pose_size);
    from += pose_size + velocity_size;
  }
  for (GazeboStep::WarmStart& start : gazebo_step_->warm_start) {
    std::copy_n(from, rows_per_hinge, start.pose.begin());
    std::copy_n(from + rows_per_hinge, rows_per_hinge, start.velocity.begin());
    from += 2 * rows_per_hinge;
  }
  from = free_->restore(from);
  for (std::size_t i = vehicle_->bodies().size(); i < all_bodies_.size(); ++i) {
    gazebo_step_->asleep[i] = *from++ != 0;
    gazebo_step_->unmoved[i] = *from++;
  }
  steps_since_contact_ =
      *from >= 0 && *from < steps_beside_contact ? static_cast<int>(*from) : steps_beside_contact;
  show();
}

}  // namespace quadcore
