// Control the height of a quadrotor from C++, like examples/step_from_python.py: fly MODEL.urdf
#include <cstdio>
#include <quadcore/simulation.hpp>
#include <vector>

int main(int count, char** arguments) try {
  if (count != 2) throw quadcore::InputError("usage: fly MODEL.urdf");

  quadcore::SimulationOptions options;
  options.spawn.xyz = {0, 0, 9};
  quadcore::Simulation sim(quadcore::read_model(quadcore::Document::read(arguments[1])),
                           quadcore::World{}, options);
  const double hover = 471, wanted = 10;  // rad/s, m
  while (sim.time() < 4) {
    const quadcore::VehicleState& state = sim.state();
    const double w =
        hover * (1 + 0.2 * (wanted - state.position.z()) - 0.2 * state.linear_velocity.z());
    const std::vector<double> speeds = {w, -w, w, -w};
    sim.command(speeds.data(), speeds.size());
    sim.step(10);
  }
  std::printf("t = %.2f s, height %.9f m\n", sim.time(), sim.state().position.z());
} catch (const quadcore::Error& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  return 2;
}
