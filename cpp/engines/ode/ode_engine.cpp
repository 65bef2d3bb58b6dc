#include "ode_engine.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "body_state.hpp"
#include "ode_math.hpp"
#include "ode_process.hpp"
#include "quadcore/error.hpp"
#include "quadcore/random.hpp"
#include "sdf_conversion.hpp"

namespace quadcore {

const OdeRecipe gazebo11_recipe{true, &add_gyroscopic_per_body};
const OdeRecipe ode_recipe{false, &add_gyroscopic_from_carrier};

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// What the sweeps may leave of an error in a step for the direct solver, which is five times
/// faster, to take their place. Flights of 10 s are 4e-10 m apart where they leave 7e-11, and 0.4
/// mm where they leave 1e-5; vehicles whose 50 sweeps do not converge leave more than that.
constexpr double converged = 1e-14;
/// So many steps beside a contact the sweeps have not converged: they start from multipliers that
/// an impact has made large.
constexpr int steps_beside_contact = 50;
/// Attitudes in which convergence is tried: it depends on them, a little.
constexpr std::uint64_t tried_attitudes = 8;

}  // namespace

OdeEngine::OdeEngine(const Model& model, const World& world, const OdeRecipe& recipe)
    : model_(recipe.like_gazebo ? converted_to_sdf(model) : model),
      recipe_(recipe),
      steps_since_contact_(steps_beside_contact),
      kinematics_(model.joints.size(), true),
      loads_(model.joints.size()) {
  start_ode();
  world_.reset(dWorldCreate());
  take_threading();
  dWorldSetGravity(world_.get(), world.gravity_W.x(), world.gravity_W.y(), world.gravity_W.z());
  dWorldSetERP(world_.get(), world.erp);
  dWorldSetCFM(world_.get(), world.cfm);
  create_bodies();
  gyroscopic_ = std::make_unique<GyroscopicVehicle>(model_, bodies_);
  const double max_correction = world.contact_max_correcting_vel;
  gazebo_step_ = std::make_unique<GazeboStep>(
      bodies_, create_hinges(), sdf_order(model_),
      GazeboStep::Options{world.solver_iterations,
                          world.solver_sor,
                          world.gravity_W,
                          {world.erp, world.cfm, recipe.like_gazebo ? max_correction : infinity}});
  if (world.ground_plane) {
    ground_ = std::make_unique<GroundContact>(model_, bodies_, max_correction);
    gazebo_step_->reserve(ground_->most());
    feedback_.resize(hinges_.size());
    for (std::size_t i = 0; i < hinges_.size(); ++i) {
      dJointSetFeedback(hinges_[i], &feedback_[i]);
    }
  }
  for (std::size_t i = 0; i < hinges_.size(); ++i) {
    kinematics_.rotors.set_matrix(MotionRow::R_FR_at_zero, i,
                                  model_.joints[i].pose.rotation().toRotationMatrix());
  }
  mass_ = mass_properties(model_).mass;
  gravity_z_ = world.gravity_W.z();
  choose_method(world);
}

/// Decided once: whether in flight the sweeps that the world asks for are to be made.
void OdeEngine::choose_method(const World& world) {
  std::ostringstream method;
  const bool quick = world.solver_type == "quick";
  if (recipe_.like_gazebo && quick) {
    const double remaining = remaining_error(world.max_step_size);
    iterate_ = remaining > converged;
    method.precision(2);
    method << "in flight ";
    if (iterate_) {
      method << "Gazebo's own " << world.solver_iterations << " sweeps, which leave " << remaining
             << " of an error of the hinges' forces in a step";
    } else {
      method << "ODE's direct solver, to which Gazebo's " << world.solver_iterations
             << " sweeps converge";
    }
  } else {
    method << "in flight ODE's direct solver";
  }
  if (ground_) method << "; on the ground " << world.solver_iterations << " of Gazebo's sweeps";
  method_ = method.str();
  if (ground_ && !quick) {
    warnings_.push_back(world.solver_type_where +
                        ": on the ground the solver type world is flown as quick; Gazebo's ends in "
                        "errors there. Write quick");
  }
  VehicleState rest;
  rest.rotor_velocity = rest.rotor_angle =
      VectorXd::Zero(static_cast<Eigen::Index>(hinges_.size()));
  set_state(rest);
}

/// The largest in some attitudes.
double OdeEngine::remaining_error(double dt) {
  double largest = 0;
  for (std::uint64_t seed = 0; seed < tried_attitudes; ++seed) {
    double count = 0;
    VehicleState state;
    for (int i = 0; i < 4; ++i) state.orientation.coeffs()[i] = random_normal(seed, count);
    const auto n = static_cast<Eigen::Index>(hinges_.size());
    state.rotor_velocity = state.rotor_angle = VectorXd::Zero(n);
    for (Eigen::Index i = 0; i < n; ++i) state.rotor_angle[i] = random_normal(seed, count);
    set_state(state);
    largest = std::max(largest, gazebo_step_->remaining_error(dt, seed));
  }
  return largest;
}

void OdeEngine::take_threading() {
  threading_.reset(dThreadingAllocateSelfThreadedImplementation());
  dWorldSetStepThreadingImplementation(
      world_.get(), dThreadingImplementationGetFunctions(threading_.get()), threading_.get());
}

void OdeEngine::create_bodies() {
  const std::vector<Eigen::Isometry3d> poses = link_poses(model_);
  for (std::size_t i = 0; i < model_.links.size(); ++i) {
    const Inertial& inertial = model_.links[i].inertial;
    const Matrix3d I = inertial.inertia_in_link_axes();
    dMass mass;
    dMassSetParameters(&mass, inertial.mass, 0, 0, 0, I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2),
                       I(1, 2));
    const dBodyID body = dBodyCreate(world_.get());
    dBodySetMass(body, &mass);
    dBodySetGyroscopicMode(body, 0);
    dBodySetGravityMode(body, model_.links[i].tags.gravity ? 1 : 0);
    bodies_.push_back(body);
    place(i, poses[i], Vector3d::Zero(), Vector3d::Zero());
  }
}

std::vector<Hinge> OdeEngine::create_hinges() {
  std::vector<Hinge> rows;
  const std::vector<Eigen::Isometry3d> poses = link_poses(model_);
  for (std::size_t i = 0; i < model_.joints.size(); ++i) {
    const Joint& joint = model_.joints[i];
    const Eigen::Isometry3d& pose = poses[i + 1];
    const Vector3d anchor = pose.translation();
    const Vector3d axis = pose.linear() * joint.axis;
    const dJointID hinge = dJointCreateHinge(world_.get(), nullptr);
    dJointAttach(hinge, bodies_[i + 1], bodies_[joint.parent]);
    dJointSetHingeAnchor(hinge, anchor.x(), anchor.y(), anchor.z());
    dJointSetHingeAxis(hinge, axis.x(), axis.y(), axis.z());
    const double implicit_damping = joint.implicit_damping ? joint.damping : 0;
    if (implicit_damping > 0) {  // a stop on either side of where the joint is
      dJointSetHingeParam(hinge, dParamLoStop, 0);
      dJointSetHingeParam(hinge, dParamHiStop, 0);
      dJointSetHingeParam(hinge, dParamStopERP, 0);
      dJointSetHingeParam(hinge, dParamStopCFM, 1 / implicit_damping);
    } else {
      dJointSetHingeParam(hinge, dParamVel, 0);
      dJointSetHingeParam(hinge, dParamFMax, joint.friction);
    }
    hinges_.push_back(hinge);
    const Vector3d& c_C = model_.links[i + 1].inertial.pose.xyz;
    const Vector3d& c_P = model_.links[joint.parent].inertial.pose.xyz;
    rows.push_back({i + 1, joint.parent, -c_C, joint.pose.xyz - c_P, joint.axis,
                    joint.pose.rotation() * joint.axis, joint.friction, implicit_damping});
  }
  return rows;
}

void OdeEngine::place(std::size_t link, const Eigen::Isometry3d& X_WL, const Vector3d& v_WL_W,
                      const Vector3d& w_WL_W) {
  const Vector3d p_LLcm_W = X_WL.linear() * model_.links[link].inertial.pose.xyz;
  const Vector3d p = X_WL.translation() + p_LLcm_W;
  const Vector3d v = v_WL_W + w_WL_W.cross(p_LLcm_W);
  const Quaterniond q(X_WL.linear());
  const dQuaternion ode_q = {q.w(), q.x(), q.y(), q.z()};
  const dBodyID body = bodies_[link];
  forget_forces(body);
  dBodySetPosition(body, p.x(), p.y(), p.z());
  dBodySetQuaternion(body, ode_q);
  dBodySetLinearVel(body, v.x(), v.y(), v.z());
  dBodySetAngularVel(body, w_WL_W.x(), w_WL_W.y(), w_WL_W.z());
}

void OdeEngine::step(double time, double dt, const ForceField& forces) {
  start_ode();
  kinematics_.time = time;
  loads_.clear();
  forces.evaluate(kinematics_, loads_);
  if (!loads_.all_finite()) forces.refuse(kinematics_, loads_);  // ODE ends the process for less
  apply_loads();
  recipe_.add_gyroscopic(*gyroscopic_, dt);
  static const std::vector<Contact> none;
  const std::vector<Contact>& contacts = ground_ ? ground_->find() : none;
  if (iterate_ || is_near_contact(dt, !contacts.empty())) {
    gazebo_step_->step(contacts, dt);
  } else {
    solve(dt);
    if (ground_) remember_hinge_forces();
  }
  damp_bodies();
  read_kinematics();
}

/// Whether this step is one on the ground or, as Gazebo's sweeps go, beside one.
bool OdeEngine::is_near_contact(double dt, bool touching) {
  if (!ground_) return false;
  const bool after = steps_since_contact_ < steps_beside_contact;
  steps_since_contact_ = touching ? 0 : std::min(steps_since_contact_ + 1, steps_beside_contact);
  if (touching) return true;
  return recipe_.like_gazebo && (after || ground_->is_ahead(steps_beside_contact * dt, gravity_z_));
}

/// <dampingFactor>: ODE's damping of bodies, after the poses have moved.
void OdeEngine::damp_bodies() {
  constexpr double slow = 0.01;  // m/s, rad/s
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const double factor = model_.links[i].tags.damping_factor;
    if (factor == 0) continue;
    const Vector3d v = vec(dBodyGetLinearVel(bodies_[i])), w = vec(dBodyGetAngularVel(bodies_[i]));
    const double keep_v = v.squaredNorm() > slow * slow ? 1 - factor : 1;
    const double keep_w = w.squaredNorm() > slow * slow ? 1 - factor : 1;
    dBodySetLinearVel(bodies_[i], keep_v * v.x(), keep_v * v.y(), keep_v * v.z());
    dBodySetAngularVel(bodies_[i], keep_w * w.x(), keep_w * w.y(), keep_w * w.z());
  }
}

/// Where ODE gives up (see start_ode), it leaves the step half done: jobs and memory.
void OdeEngine::solve(double dt) {
  try {
    dWorldStep(world_.get(), dt);
  } catch (...) {
    dWorldCleanupWorkingMemory(world_.get());
    threading_.release();  // ODE does not free a job list that is not empty
    take_threading();
    throw;
  }
}

/// A step with contacts starts from the hinge forces of the step before, which the direct solver
/// reports through the joints' feedback.
void OdeEngine::remember_hinge_forces() {
  for (std::size_t i = 0; i < hinges_.size(); ++i) {
    const Matrix3d R_WC = rotation(dBodyGetRotation(bodies_[i + 1]));
    const Vector3d f_W = vec(feedback_[i].f1);
    const Vector3d anchor_W = R_WC * -model_.links[i + 1].inertial.pose.xyz;
    const Vector3d tau_W = vec(feedback_[i].t1) - anchor_W.cross(f_W);
    const Vector3d axis_W = R_WC * model_.joints[i].axis;
    const auto across_W = plane_space(axis_W);
    const GazeboStep::Multipliers multipliers = {
        f_W.x(),          f_W.y(), f_W.z(), tau_W.dot(across_W[0]), tau_W.dot(across_W[1]),
        tau_W.dot(axis_W)};
    gazebo_step_->warm_start[i] = {multipliers, multipliers};
  }
}

void OdeEngine::apply_loads() {
  const Matrix3d& R_WF = kinematics_.R_WF;
  const Wrench frame = loads_.frame();
  const Vector3d f_W = R_WF * frame.force_F;
  const Vector3d tau_Fcm_W =
      R_WF * (frame.torque_F - model_.links[0].inertial.pose.xyz.cross(frame.force_F));
  dBodyAddForce(bodies_[0], f_W.x(), f_W.y(), f_W.z());
  dBodyAddTorque(bodies_[0], tau_Fcm_W.x(), tau_Fcm_W.y(), tau_Fcm_W.z());
  for (std::size_t i = 0; i < hinges_.size(); ++i) {
    const Vector3d f_R_W = R_WF * loads_.rotor_force_F(i);
    dBodyAddForce(bodies_[i + 1], f_R_W.x(), f_R_W.y(), f_R_W.z());
    const Joint& joint = model_.joints[i];
    const double damping = joint.implicit_damping ? 0 : -joint.damping * kinematics_.rotors[i].rate;
    dJointAddHingeTorque(hinges_[i], damping + loads_.joint_torque(i));
  }
}

void OdeEngine::read_kinematics() {
  Kinematics& k = kinematics_;
  const Vector3d& p_FFcm_F = model_.links[0].inertial.pose.xyz;
  const dReal* q = dBodyGetQuaternion(bodies_[0]);
  k.q_WF = Quaterniond(q[0], q[1], q[2], q[3]);
  k.R_WF = rotation(dBodyGetRotation(bodies_[0]));
  const Matrix3d R_FW = k.R_WF.transpose();
  k.w_WF_F = R_FW * vec(dBodyGetAngularVel(bodies_[0]));
  const Vector3d v_WFcm_F = R_FW * vec(dBodyGetLinearVel(bodies_[0]));
  k.v_WF_F = v_WFcm_F - k.w_WF_F.cross(p_FFcm_F);
  k.p_WF = vec(dBodyGetPosition(bodies_[0])) - k.R_WF * p_FFcm_F;
  k.p_FCcm_F = model_.links[0].inertial.mass * p_FFcm_F;
  k.v_WCcm_F = model_.links[0].inertial.mass * v_WFcm_F;
  for (std::size_t i = 0; i < hinges_.size(); ++i) {
    const Joint& joint = model_.joints[i];
    const dBodyID body = bodies_[i + 1];
    const Inertial& inertial = model_.links[i + 1].inertial;
    const Matrix3d R_FR = R_FW * rotation(dBodyGetRotation(body));
    const Vector3d w_WR_F = R_FW * vec(dBodyGetAngularVel(body));
    Vector3d w_WP_F = k.w_WF_F;
    if (joint.parent != 0) {  // the carrier turns as well
      w_WP_F = R_FW * vec(dBodyGetAngularVel(bodies_[joint.parent]));
      k.rotors.set_matrix(MotionRow::R_FR_at_zero, i,
                          k.R_FR(joint.parent - 1) * joint.pose.rotation().toRotationMatrix());
    }
    RotorKinematics rotor;
    rotor.axis_F = R_FR * joint.axis;
    rotor.normal_F = R_FR.col(2);
    rotor.p_FRcm_F = R_FW * (vec(dBodyGetPosition(body)) - k.p_WF);
    rotor.v_WRcm_F = R_FW * vec(dBodyGetLinearVel(body));
    rotor.v_WR_F = rotor.v_WRcm_F - w_WR_F.cross(R_FR * inertial.pose.xyz);
    rotor.rate = rotor.axis_F.dot(w_WR_F - w_WP_F);
    k.rotors.set(i, rotor);
    k.rotors.set_matrix(MotionRow::R_FR, i, R_FR);
    k.p_FCcm_F += inertial.mass * rotor.p_FRcm_F;
    k.v_WCcm_F += inertial.mass * rotor.v_WRcm_F;
  }
  k.p_FCcm_F /= mass_;
  k.v_WCcm_F /= mass_;
}

void OdeEngine::get_state(VehicleState& state) const {
  state.position = kinematics_.p_WF;
  state.orientation = kinematics_.q_WF;
  state.linear_velocity = kinematics_.R_WF * kinematics_.v_WF_F;
  state.angular_velocity = kinematics_.w_WF_F;
  for (std::size_t i = 0; i < hinges_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    state.rotor_velocity[row] = kinematics_.rotors[i].rate;
    state.rotor_angle[row] = kinematics_.angle(i);
  }
}

void OdeEngine::set_state(const VehicleState& state) {
  std::vector<Eigen::Isometry3d> X_WL(model_.links.size());
  std::vector<Vector3d> v_W(model_.links.size()), w_W(model_.links.size());
  const Quaterniond q = state.orientation.normalized();
  X_WL[0] = Eigen::Translation3d(state.position) * q;
  v_W[0] = state.linear_velocity;
  w_W[0] = q * state.angular_velocity;
  for (std::size_t i = 0; i < model_.joints.size(); ++i) {
    const Joint& joint = model_.joints[i];
    const auto row = static_cast<Eigen::Index>(i);
    const std::size_t parent = joint.parent, child = i + 1;
    X_WL[child] = X_WL[parent] * Eigen::Translation3d(joint.pose.xyz) * joint.pose.rotation() *
                  quaternion_about(joint.axis, state.rotor_angle[row]);
    const Vector3d arm_W = X_WL[child].translation() - X_WL[parent].translation();
    v_W[child] = v_W[parent] + w_W[parent].cross(arm_W);
    w_W[child] = w_W[parent] + X_WL[child].linear() * joint.axis * state.rotor_velocity[row];
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i) place(i, X_WL[i], v_W[i], w_W[i]);
  std::fill(gazebo_step_->warm_start.begin(), gazebo_step_->warm_start.end(),
            GazeboStep::WarmStart{});
  steps_since_contact_ = steps_beside_contact;
  read_kinematics();
}

std::size_t OdeEngine::saved_size() const {
  return bodies_.size() * (pose_size + velocity_size) + hinges_.size() * 2 * rows_per_hinge + 1;
}

std::vector<double> OdeEngine::save() const {
  std::vector<double> saved(saved_size());
  double* to = saved.data();
  for (const dBodyID body : bodies_) {
    save_pose(body, to);
    save_velocity(body, to + pose_size);
    to += pose_size + velocity_size;
  }
  for (const GazeboStep::WarmStart& start : gazebo_step_->warm_start) {
    to = std::copy(start.pose.begin(), start.pose.end(), to);
    to = std::copy(start.velocity.begin(), start.velocity.end(), to);
  }
  *to = steps_since_contact_;
  return saved;
}

void OdeEngine::restore(const std::vector<double>& saved) {
  if (saved.size() != saved_size()) {
    throw InputError("snapshot: was taken from another model or engine; restore one of its own");
  }
  const double* from = saved.data();
  for (const dBodyID body : bodies_) {
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
  steps_since_contact_ = static_cast<int>(*from);
  read_kinematics();
}

}  // namespace quadcore
