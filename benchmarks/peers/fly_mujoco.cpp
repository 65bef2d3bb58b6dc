// The flight in MuJoCo, all forces of it in C++: what fly_mujoco.py calls.
#include <mujoco/mujoco.h>

namespace {

constexpr int rotors = 4, frame = 1;  // bodies: 0 is the world, the frame, the rotors
const double* spins;
double thrust, torque;

/// Thrust on each rotor and the air's opposing torque on the frame, in world axes.
void act(const mjModel* model, mjData* data) {
  mju_zero(data->xfrc_applied, 6 * model->nbody);
  const double* R_WF = data->xmat + 9 * frame;
  const double up_W[3] = {R_WF[2], R_WF[5], R_WF[8]};
  for (int i = 0; i < rotors; ++i) {
    const double w = data->qvel[6 + i];
    mju_scl3(data->xfrc_applied + 6 * (frame + 1 + i), up_W, thrust * w * w);
    mju_addToScl3(data->xfrc_applied + 6 * frame + 3, up_W, -spins[i] * torque * w * w);
  }
}

}  // namespace

extern "C" int fly(const char* path, int phases, const double* commands, const int* counts,
                   const double* spins_given, double thrust_given, double torque_given,
                   double* p_Wcm) {
  char error[200];
  mjModel* model = mj_loadXML(path, nullptr, error, sizeof error);
  if (!model) return 1;
  mjData* data = mj_makeData(model);
  spins = spins_given, thrust = thrust_given, torque = torque_given;
  mjcb_control = act;
  for (int phase = 0; phase < phases; ++phase) {
    mju_copy(data->ctrl, commands + rotors * phase, rotors);
    for (int i = 0; i < counts[phase]; ++i) mj_step(model, data);
  }
  mj_forward(model, data);
  mju_copy3(p_Wcm, data->subtree_com + 3 * frame);
  mj_deleteData(data);
  mj_deleteModel(model);
  return 0;
}
