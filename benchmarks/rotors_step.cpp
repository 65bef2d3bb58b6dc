/// Time of a step of RotorS' firefly in quadcore (engine gazebo11, all its modules) and of nothing
/// but ODE's own QuickStep for the same bodies and hinges, with as many sweeps. Real Gazebo 11,
/// which solves each step twice, for poses and for velocities, takes three times the latter at 50
/// sweeps (18,000 steps/s of a hexarotor on a machine where this loop takes 18.4 us), and at 1000,
/// where all is sweeps, at least twice.
///
///     rotors_step firefly.urdf basic.world [ROUNDS]

#include <ode/ode.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <vector>

#include "quadcore/simulation.hpp"
#include "timing.hpp"

namespace {

using namespace quadcore;

constexpr double hover = 543.4;  // rad/s

/// The model's bodies on hinges in an ODE world, spinning.
class BareOde {
 public:
  BareOde(const Model& model, const World& world) : world_(dWorldCreate()) {
    dWorldSetGravity(world_, 0, 0, -9.8);
    dWorldSetERP(world_, world.erp);
    dWorldSetCFM(world_, world.cfm);
    dWorldSetQuickStepNumIterations(world_, world.solver_iterations);
    const std::vector<Eigen::Isometry3d> poses = link_poses(model);
    std::vector<dBodyID> bodies;
    for (std::size_t i = 0; i < model.links.size(); ++i) {
      const Inertial& inertial = model.links[i].inertial;
      const Matrix3d I = inertial.inertia_in_link_axes();
      dMass mass;
      dMassSetParameters(&mass, inertial.mass, 0, 0, 0, I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2),
                         I(1, 2));
      bodies.push_back(dBodyCreate(world_));
      dBodySetMass(bodies.back(), &mass);
      dBodySetGyroscopicMode(bodies.back(), 0);
      const Vector3d p = poses[i] * inertial.pose.xyz;
      dBodySetPosition(bodies.back(), p.x(), p.y(), p.z());
    }
    for (std::size_t i = 0; i < model.joints.size(); ++i) {
      const dJointID hinge = dJointCreateHinge(world_, nullptr);
      dJointAttach(hinge, bodies[i + 1], bodies[0]);
      const Vector3d p = poses[i + 1].translation();
      dJointSetHingeAnchor(hinge, p.x(), p.y(), p.z());
      dJointSetHingeAxis(hinge, 0, 0, 1);
      dBodySetAngularVel(bodies[i + 1], 0, 0, (i % 2 ? -1 : 1) * hover / 10);
    }
  }
  ~BareOde() { dWorldDestroy(world_); }
  BareOde(const BareOde&) = delete;
  BareOde& operator=(const BareOde&) = delete;

  double seconds_per_step(int steps, double dt) {
    const double start = now();
    for (int i = 0; i < steps; ++i) dWorldQuickStep(world_, dt);
    return (now() - start) / steps;
  }

 private:
  dWorldID world_;
};

double seconds_per_step(Simulation& simulation, int steps) {
  const double start = now();
  simulation.step(steps);
  return (now() - start) / steps;
}

void compare(const char* name, const Model& model, const World& world, int steps, int rounds,
             double gazebo, double bar) {
  std::vector<double> bare_times, quadcore_times, ratios;
  for (int round = 0; round < rounds; ++round) {
    SimulationOptions options;
    options.spawn.xyz.z() = 10;
    Simulation simulation(model, world, options);
    const std::vector<double> speeds(simulation.command_width(), hover);
    simulation.command(speeds.data(), speeds.size());
    BareOde bare(model, world);
    bare_times.push_back(bare.seconds_per_step(steps, simulation.dt()));
    quadcore_times.push_back(seconds_per_step(simulation, steps));
    ratios.push_back(gazebo * bare_times.back() / quadcore_times.back());
  }
  std::printf("%s\n", name);
  std::printf("  bare QuickStep, us per step       %8.2f\n", 1e6 * quantile(bare_times, 0.5));
  std::printf("  quadcore, us per step             %8.2f\n", 1e6 * quantile(quadcore_times, 0.5));
  std::printf(
      "  %g times the former / the latter   %8.1f   at least %.0f   (quartiles %.1f, %.1f)\n",
      gazebo, quantile(ratios, 0.5), bar, quantile(ratios, 0.25), quantile(ratios, 0.75));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3 || argc > 4) {
    std::fprintf(stderr, "usage: %s firefly.urdf basic.world [ROUNDS]\n", argv[0]);
    return 2;
  }
  try {
    dInitODE();
    const int rounds = argc == 4 ? std::max(1, std::atoi(argv[3])) : 51;
    const Model model = read_model(Document::read(argv[1]));
    compare("firefly, 1 ms, 50 sweeps", model, World{}, 1000, rounds, 3, 4);
    compare("firefly in basic.world, 10 ms, 1000 sweeps", model,
            read_world(Document::read(argv[2])), 100, rounds, 2, 50);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
}
