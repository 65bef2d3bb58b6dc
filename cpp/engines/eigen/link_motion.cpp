#include "link_motion.hpp"

namespace quadcore {

LinkMotion find_link_motion(const Kinematics& k, std::size_t link) {
  if (link == 0) return {k.R_WF, k.p_WF, k.R_WF * k.v_WF_F, k.R_WF * k.w_WF_F};
  const RotorKinematics rotor = k.rotors[link - 1];
  return {k.R_WF * k.R_FR(link - 1), k.p_WF + k.R_WF * rotor.p_FRcm_F, k.R_WF * rotor.v_WRcm_F,
          k.R_WF * (k.w_WF_F + rotor.rate * rotor.axis_F)};
}

LinkMotion find_shape_motion(const Model& model, const Kinematics& k, std::size_t link,
                             const Collision& shape) {
  LinkMotion motion = find_link_motion(k, link);
  const Vector3d& origin_L =
      link == 0 ? Vector3d::Zero().eval() : model.links[link].inertial.pose.xyz;
  motion.p_WS = motion.p_W + motion.R_WL * (shape.pose.xyz - origin_L);
  return motion;
}

void add_link_load(const Kinematics& k, std::size_t link, const Vector3d& f_W,
                   const Vector3d& tau_W, Loads& loads) {
  const Vector3d f_F = k.R_WF.transpose() * f_W;
  const Vector3d tau_F = k.R_WF.transpose() * tau_W;
  if (link == 0) {
    loads.add_frame_force(0, f_F, Vector3d::Zero());
    loads.add_frame_torque(0, tau_F);
    return;
  }
  const std::size_t rotor = link - 1;
  loads.rotors().add_vector(LoadRow::force, rotor, f_F);
  loads.rotors().add_vector(LoadRow::reaction, rotor, tau_F);
  loads.add_joint_torque(rotor, k.rotors[rotor].axis_F.dot(tau_F));
}

}  // namespace quadcore
