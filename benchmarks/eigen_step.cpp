/// Time of a step of the engine eigen, with the three plugins of the URDF and chapter-2 drag, over
/// that of the same physics in one hand-written function (the floor) and over that of gazebo11.
/// All fly in turns in this one process.
///
///     eigen_step quadrotor.urdf [ROUNDS]

#include <cstdio>
#include <cstdlib>
#include <exception>

#include "bare_gyrostat.hpp"
#include "quadcore/simulation.hpp"
#include "timing.hpp"

namespace {

constexpr double spawn_height = 10;  // m
constexpr int steps = 4000;
constexpr double speeds[2][4] = {{480, -480, 480, -480}, {479.9, -480, 480.1, -480}};
constexpr double largest_distance = 1e-9;
constexpr double largest_over_floor = 3;

void command(bare::Gyrostat& vehicle, const double* rotors) { vehicle.command(rotors); }
void command(quadcore::Simulation& vehicle, const double* rotors) { vehicle.command(rotors, 4); }

template <typename Vehicle>
double seconds_per_step(Vehicle& vehicle) {
  const double start = now();
  for (const auto& rotors : speeds) {
    command(vehicle, rotors);
    vehicle.step(steps / 2);
  }
  return (now() - start) / steps;
}

int compare(const char* urdf, int rounds) {
  using namespace quadcore;
  const Model model = read_model(Document::read(urdf));
  SimulationOptions options;
  options.spawn.xyz.z() = spawn_height;
  options.parameters["drone_plugin.dragModel"] = "chapter2";
  SimulationOptions exact = options;
  exact.engine = "eigen";
  std::vector<double> times, over_floor, over_gazebo11;
  double apart = 0;
  for (int round = 0; round < rounds; ++round) {
    bare::Gyrostat floor(model, spawn_height);
    Simulation eigen(model, World{}, exact), gazebo11(model, World{}, options);
    const double bare_time = seconds_per_step(floor);
    times.push_back(seconds_per_step(eigen));
    over_floor.push_back(times.back() / bare_time);
    over_gazebo11.push_back(times.back() / seconds_per_step(gazebo11));
    apart = std::max(apart, (floor.position() - eigen.state().position).norm());
  }
  std::printf("eigen, us per step                  %7.3f\n", 1e6 * quantile(times, 0.5));
  std::printf("eigen / hand-written floor          %7.3f   at most %.2f   (quartiles %.3f, %.3f)\n",
              quantile(over_floor, 0.5), largest_over_floor, quantile(over_floor, 0.25),
              quantile(over_floor, 0.75));
  std::printf("eigen / gazebo11                    %7.3f   (quartiles %.3f, %.3f)\n",
              quantile(over_gazebo11, 0.5), quantile(over_gazebo11, 0.25),
              quantile(over_gazebo11, 0.75));
  std::printf("end positions apart, m              %7.0e   at most %.0e\n", apart,
              largest_distance);
  return apart <= largest_distance ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: eigen_step quadrotor.urdf [ROUNDS]\n");
    return 2;
  }
  try {
    return compare(argv[1], argc > 2 ? std::atoi(argv[2]) : 101);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
}
