#include "hinged_model.hpp"

#include <algorithm>

#include "ode_math.hpp"

namespace quadcore {

std::vector<double> body_constants(const Model& model, std::size_t body) {
  using Row = BodyConstant;
  std::vector<double> rows(Row::count);
  const auto put = [&rows](std::size_t row, const Vector3d& v) {
    std::copy_n(v.data(), 3, &rows[row]);
  };
  const Link& link = model.links[body];
  rows[Row::mass] = link.inertial.mass;
  rows[Row::weight] = link.tags.gravity ? link.inertial.mass : 0;
  const Matrix3d I = link.inertial.inertia_in_link_axes();
  put(Row::inertia, {I(0, 0), I(0, 1), I(0, 2)});
  put(Row::inertia + 3, {I(1, 1), I(1, 2), I(2, 2)});
  put(Row::origin, -link.inertial.pose.xyz);
  if (body == 0) return rows;
  const Joint& joint = model.joints[body - 1];
  put(Row::anchor_P, joint.pose.xyz - model.links[joint.parent].inertial.pose.xyz);
  put(Row::axis_C, joint.axis);
  put(Row::axis_P, joint.pose.rotation() * joint.axis);
  rows[joint.implicit_damping ? Row::implicit_damping : Row::damping] = joint.damping;
  const auto across_C = plane_space(joint.axis);
  put(Row::across_C, across_C[0]);
  put(Row::across_C + 3, across_C[1]);
  std::copy_n(joint.pose.rotation().coeffs().data(), 4, &rows[Row::q_PC_at_zero]);
  return rows;
}

HingedModel::HingedModel(const Bodies& bodies)
    : carriers(bodies.model.links.size()),
      carries(carriers.size()),
      brakes(carriers.size()),
      locks(carriers.size()) {
  for (std::size_t i = 0; i + 1 < carriers.size(); ++i) {
    const Joint& joint = bodies.model.joints[i];
    carriers[i + 1] = joint.parent;
    carries[joint.parent] = true;
    brakes[i + 1] = joint.implicit_damping && joint.damping > 0;
    locks[i + 1] = bodies.is_locked(i);
  }
}

HingedTree HingedModel::tree(const World& world, double max_correction) const {
  // Finite, including its square, because compiler options for the steps may assume finite numbers.
  constexpr double unlimited = 1e100;
  const Vector3d& g_W = world.gravity_W;
  return {carriers.size(), carriers.data(), carries.data(),
          brakes.data(),   locks.data(),    {g_W.x(), g_W.y(), g_W.z()},
          world.erp,       world.cfm,       std::min(max_correction, unlimited)};
}

bool HingedModel::is_star() const {
  const auto is_zero = [](auto number) { return number == 0; };
  return std::all_of(carriers.begin(), carriers.end(), is_zero) &&
         std::all_of(brakes.begin(), brakes.end(), is_zero) &&
         std::all_of(locks.begin(), locks.end(), is_zero);
}

}  // namespace quadcore
