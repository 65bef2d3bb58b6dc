#include "compliant_ground.hpp"

#include <algorithm>
#include <sstream>

#include "contact_surface.hpp"
#include "link_motion.hpp"
#include "lowest_point.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/plugin/world.hpp"
#include "touching_points.hpp"

namespace quadcore {

CompliantGround::CompliantGround(const Model& model, const Gyrostat& body, const Surface& ground)
    : model_(model),
      weight_(World{}.gravity_W.norm() / body.inverse_mass),
      reach_(find_reach(model, body)) {
  check_collisions(model);
  const std::vector<StableContact> stable = stable_contacts(model, body);
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
    }
  }
}

bool CompliantGround::is_ahead(const Kinematics& k, double dt) const {
  for (const Shape& shape : shapes_) {
    const LinkMotion motion = find_shape_motion(model_, k, shape.link, *shape.collision);
    const double turning = shape.turns ? motion.w_W.norm() : k.w_WF_F.norm();
    const double speed = std::max(0.0, turning * shape.reach - motion.velocity(motion.p_WS).z());
    if (lowest(shape, motion) < laws::ahead(speed, dt)) return true;
  }
  return false;
}

double CompliantGround::lowest(const Shape& shape, const LinkMotion& motion) {
  return motion.p_WS.z() - reach_down(*shape.collision, motion.R_WL * shape.R_LS);
}

void CompliantGround::refuse_deep(const Kinematics& k, double dt) const {
  double deepest = 0, hardest = 0;
  for (const Shape& shape : shapes_) {
    const double depth = -lowest(shape, find_shape_motion(model_, k, shape.link, *shape.collision));
    const Spring press = make_spring(shape.stable.pressing, shape.hardest, dt);
    deepest = std::max(deepest, depth);
    hardest = std::max(hardest, press.stiffness * depth);
  }
  if (hardest <= largest_start_force * weight_) return;
  std::ostringstream what;
  what << "the vehicle starts " << deepest
       << " m deep in the ground, and the contact of the engine eigen would throw it up. Start at "
          "z = "
       << k.p_WF.z() + deepest << " or above, or use the engine ode or gazebo11.";
  throw Error(what.str());
}

void CompliantGround::begin(double dt) {
  dt_ = dt;
  stage_ = 0;
  for (Shape& shape : shapes_) {
    shape.press = make_spring(shape.stable.pressing, shape.hardest, dt);
    shape.bristle.begin(make_spring(shape.stable.rubbing, shape.hardest, dt));
  }
}

void CompliantGround::add_forces(const Kinematics& kinematics, Loads& loads) {
  for (Shape& shape : shapes_) press(shape, kinematics, loads);
  ++stage_;
}

void CompliantGround::press(Shape& shape, const Kinematics& k, Loads& loads) {
  const LinkMotion motion = find_shape_motion(model_, k, shape.link, *shape.collision);
  PressedPatch patch;
  double& pressing = patch.pressing;
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
  if (!(pressing > 0)) return shape.bristle.release(stage_, dt_);
  center_W /= pressing;
  for (int i = 0; i < count; ++i) {
    patch.square += forces[i] * (points_W[i] - center_W).head<2>().squaredNorm();
  }
  patch.reach = shape.reach;
  patch.direction = R_WS * shape.collision->surface.fdir1;
  patch.friction = pressing * Vector3d(shape.mu1, shape.mu2, (shape.mu1 + shape.mu2) / 2);
  const PatchResistance resistance =
      shape.bristle.resist(patch, motion.velocity(center_W), motion.w_W, stage_, dt_);
  tau_W += (center_W - motion.p_W).cross(resistance.along);
  tau_W += resistance.turning;
  add_link_load(k, shape.link, resistance.along + pressing * Vector3d::UnitZ(), tau_W, loads);
}

void CompliantGround::end() {
  for (Shape& shape : shapes_) shape.bristle.end(dt_);
}

void CompliantGround::clear() {
  for (Shape& shape : shapes_) shape.bristle.clear();
}

double* CompliantGround::save(double* to) const {
  for (const Shape& shape : shapes_) to = shape.bristle.save(to);
  return to;
}

const double* CompliantGround::restore(const double* from) {
  for (Shape& shape : shapes_) from = shape.bristle.restore(from);
  return from;
}

}  // namespace quadcore
