#include "compliant_ground.hpp"

#include <algorithm>
#include <limits>
#include <sstream>

#include "contact_surface.hpp"
#include "lowest_point.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/plugin/world.hpp"
#include "touching_points.hpp"

namespace quadcore {
namespace {

/// Coefficients of the classical Runge-Kutta method: weight of each stage's rate in the sum, and
/// distance from the start of the step to the next stage, as a fraction of the step.
constexpr double weights[] = {1, 2, 2, 1}, reaches[] = {0.5, 0.5, 1, 0};
/// Maximum force of a point on the ground at the start of a flight, in weights of the vehicle.
constexpr double hardest_start = 10;

}  // namespace

/// Axes of a body's link, and a point of the body with its velocity, in world axes.
struct CompliantGround::Motion {
  Matrix3d R_WL;
  Vector3d p_W, v_W, w_W;
  Vector3d p_WS = {0, 0, 0};  ///< position of one of its shapes
  Vector3d velocity(const Vector3d& q_W) const { return v_W + w_W.cross(q_W - p_W); }
};

CompliantGround::CompliantGround(const Model& model, const Gyrostat& body, const Surface& ground)
    : model_(model),
      weight_(World{}.gravity_W.norm() / body.inverse_mass),
      reach_(-std::numeric_limits<double>::infinity()) {
  check_collisions(model);
  const std::vector<StableContact> stable = stable_contacts(model, body);
  const std::vector<Eigen::Isometry3d> poses = link_poses(model);
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    for (const Collision& collision : model.links[i].collisions) {
      Shape shape;
      shape.link = i;
      shape.collision = &collision;
      shape.R_LS = collision.pose.rotation().toRotationMatrix();
      shape.reach = outer_radius(collision.kind, collision.size);
      shape.turns = i > 0 && !revolves(model, i, collision);
      shape.stable = stable[shapes_.size()];
      shape.hardest = joint_stiffness(collision.surface, ground);
      shape.mu1 = joint_mu1(collision.surface, ground);
      shape.mu2 = joint_mu2(collision.surface, ground);
      shapes_.push_back(shape);
      const Vector3d p_CL = poses[i].translation() - body.p_FCcm_F;
      reach_ = std::max(reach_, p_CL.norm() + collision.pose.xyz.norm() + shape.reach);
    }
  }
}

CompliantGround::Motion CompliantGround::motion_of(const Kinematics& k, std::size_t link) const {
  if (link == 0) return {k.R_WF, k.p_WF, k.R_WF * k.v_WF_F, k.R_WF * k.w_WF_F};
  const RotorKinematics rotor = k.rotors[link - 1];
  return {k.R_WF * k.R_FR(link - 1), k.p_WF + k.R_WF * rotor.p_FRcm_F, k.R_WF * rotor.v_WRcm_F,
          k.R_WF * (k.w_WF_F + rotor.rate * rotor.axis_F)};
}

CompliantGround::Motion CompliantGround::motion_of(const Kinematics& k, const Shape& shape) const {
  Motion motion = motion_of(k, shape.link);
  const Vector3d& origin_L =
      shape.link == 0 ? Vector3d::Zero().eval() : model_.links[shape.link].inertial.pose.xyz;
  motion.p_WS = motion.p_W + motion.R_WL * (shape.collision->pose.xyz - origin_L);
  return motion;
}

bool CompliantGround::is_ahead(const Kinematics& k, double dt) const {
  for (const Shape& shape : shapes_) {
    const Motion motion = motion_of(k, shape);
    const double turning = shape.turns ? motion.w_W.norm() : k.w_WF_F.norm();
    const double speed = std::max(0.0, turning * shape.reach - motion.velocity(motion.p_WS).z());
    if (lowest(shape, motion) < laws::ahead(speed, dt)) return true;
  }
  return false;
}

double CompliantGround::lowest(const Shape& shape, const Motion& motion) {
  return motion.p_WS.z() - reach_down(*shape.collision, motion.R_WL * shape.R_LS);
}

void CompliantGround::refuse_deep(const Kinematics& k, double dt) const {
  double deepest = 0, hardest = 0;
  for (const Shape& shape : shapes_) {
    const double depth = -lowest(shape, motion_of(k, shape));
    const Spring press = spring(shape.stable.pressing, shape.hardest, dt);
    deepest = std::max(deepest, depth);
    hardest = std::max(hardest, press.stiffness * depth);
  }
  if (hardest <= hardest_start * weight_) return;
  std::ostringstream what;
  what << "the vehicle starts " << deepest
       << " m deep in the ground, and the contact of the engine eigen would throw it up. Start at "
          "z = "
       << k.p_WF.z() + deepest << " or above, or use the engine ode or gazebo11.";
  throw Error(what.str());
}

/// Return the stiffest stable spring, limited by the surface; a softer one has the same damping
/// ratio.
CompliantGround::Spring CompliantGround::spring(double stable, double hardest, double dt) {
  const double stiffness = std::min(stable / (dt * dt), hardest);
  const double relaxation = largest_damping_per_step / largest_square_per_step * dt;
  return {stiffness, relaxation * std::sqrt(stable / (stiffness * dt * dt))};
}

void CompliantGround::begin(double dt) {
  dt_ = dt;
  stage_ = 0;
  for (Shape& shape : shapes_) {
    shape.press = spring(shape.stable.pressing, shape.hardest, dt);
    shape.rub = spring(shape.stable.rubbing, shape.hardest, dt);
    shape.bent = shape.bristle;
    shape.sum.setZero();
  }
}

void CompliantGround::add_forces(const Kinematics& kinematics, Loads& loads) {
  for (Shape& shape : shapes_) press(shape, kinematics, loads);
  ++stage_;
}

void CompliantGround::press(Shape& shape, const Kinematics& k, Loads& loads) {
  shape.force = 0;
  shape.friction.setZero();
  const Motion motion = motion_of(k, shape);
  double& pressing = shape.force;
  Vector3d center_W = Vector3d::Zero(), tau_W = Vector3d::Zero();
  const Matrix3d R_WS = motion.R_WL * shape.R_LS;
  Vector3d points_W[most_touching_points];
  double forces[most_touching_points];
  int count = 0;
  if (motion.p_WS.z() < shape.reach) {
    count = touching_points(*shape.collision, motion.p_WS, R_WS, points_W);
  }
  for (int i = 0; i < count; ++i) {
    forces[i] = laws::pressure(shape.press.stiffness, shape.press.relaxation, -points_W[i].z(),
                               -motion.velocity(points_W[i]).z());
    pressing += forces[i];
    center_W += forces[i] * points_W[i];
    tau_W += (points_W[i] - motion.p_W).cross(forces[i] * Vector3d::UnitZ());
  }
  if (!(pressing > 0)) {
    rub(shape, Bent::Zero());
    return;
  }
  center_W /= pressing;
  double square = 0;
  for (int i = 0; i < count; ++i) {
    square += forces[i] * (points_W[i] - center_W).head<2>().squaredNorm();
  }
  const double arm = laws::rolling_resistance * shape.reach;
  const double radius = std::sqrt(square / pressing + arm * arm);
  const double lever = laws::rolling_lever * shape.reach;
  const Vector3d along_W = R_WS * shape.collision->surface.fdir1;
  const double length = along_W.head<2>().norm();
  shape.axis_W = length > 0 ? (along_W.head<2>() / length).eval() : Eigen::Vector2d(0, -1);
  shape.friction = pressing * Vector3d(shape.mu1, shape.mu2, (shape.mu1 + shape.mu2) / 2);
  const Vector3d v_W = motion.velocity(center_W);
  const Vector3d& w_W = motion.w_W;
  Bent rate;
  rate << v_W.x(), v_W.y(), radius * w_W.z(), lever * w_W.x(), lever * w_W.y();
  const Bent resistance = rub(shape, rate);
  const Vector3d along = {resistance[0], resistance[1], 0};
  tau_W += (center_W - motion.p_W).cross(along);
  tau_W += Vector3d(lever * resistance[3], lever * resistance[4], radius * resistance[2]);
  const Vector3d f_F = k.R_WF.transpose() * (along + pressing * Vector3d::UnitZ());
  const Vector3d tau_F = k.R_WF.transpose() * tau_W;
  if (shape.link == 0) {
    loads.add_frame_force(0, f_F, Vector3d::Zero());
    loads.add_frame_torque(0, tau_F);
    return;
  }
  const std::size_t rotor = shape.link - 1;
  loads.rotors().add_vector(LoadRow::force, rotor, f_F);
  loads.rotors().add_vector(LoadRow::reaction, rotor, tau_F);
  loads.add_joint_torque(rotor, k.rotors[rotor].axis_F.dot(tau_F));
}

/// Return the resistance of a shape with its bristle moving at a rate [m/s], and advance to the
/// next stage.
CompliantGround::Bent CompliantGround::rub(Shape& shape, const Bent& rate) {
  const auto& [stiffness, relaxation] = shape.rub;
  const Bent resistance = possible(shape, -stiffness * (shape.bent + relaxation * rate));
  shape.sum += weights[stage_] * rate;
  shape.bent = shape.bristle + reaches[stage_] * dt_ * rate;
  return resistance;
}

/// Limit a resistance by friction, in the axes of the friction.
CompliantGround::Bent CompliantGround::possible(const Shape& shape, const Bent& wanted_W) {
  const double x = shape.axis_W.x(), y = shape.axis_W.y();
  Bent wanted = wanted_W;
  wanted[0] = x * wanted_W[0] + y * wanted_W[1];
  wanted[1] = x * wanted_W[1] - y * wanted_W[0];
  const Bent possible = laws::possible(shape.friction, shape.force, wanted);
  Bent possible_W = possible;
  possible_W[0] = x * possible[0] - y * possible[1];
  possible_W[1] = y * possible[0] + x * possible[1];
  return possible_W;
}

void CompliantGround::end() {
  for (Shape& shape : shapes_) {
    const Bent bent = shape.bristle + dt_ / 6 * shape.sum;
    shape.bristle = possible(shape, shape.rub.stiffness * bent) / shape.rub.stiffness;
  }
}

void CompliantGround::clear() {
  for (Shape& shape : shapes_) shape.bristle.setZero();
}

double* CompliantGround::save(double* to) const {
  for (const Shape& shape : shapes_) {
    to = std::copy(shape.bristle.data(), shape.bristle.data() + Bent::SizeAtCompileTime, to);
  }
  return to;
}

const double* CompliantGround::restore(const double* from) {
  for (Shape& shape : shapes_) {
    std::copy(from, from + Bent::SizeAtCompileTime, shape.bristle.data());
    from += Bent::SizeAtCompileTime;
  }
  return from;
}

std::vector<std::string> CompliantGround::warnings() const {
  std::vector<std::string> all;
  const Surface usual;
  for (const Shape& shape : shapes_) {
    const Surface& surface = shape.collision->surface;
    if (surface.kd == usual.kd && surface.min_depth == usual.min_depth &&
        surface.max_vel == usual.max_vel && surface.max_contacts == usual.max_contacts) {
      continue;
    }
    all.push_back(shape.collision->where +
                  ": the engine eigen ignores <kd>, <minDepth>, <maxVel> and <maxContacts> of this "
                  "shape. Use the engine ode or gazebo11 to include them.");
  }
  return all;
}

}  // namespace quadcore
