/// Time of a step of quadcore (engine gazebo11, the three plugins of the URDF) over that of the
/// same flight written by hand on bare ODE. Both fly in turns in this one process, so that whatever
/// else the machine does meets both alike.
///
///     ode_step quadrotor.urdf [ROUNDS]

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <vector>

#include "bare_ode.hpp"
#include "quadcore/simulation.hpp"
#include "timing.hpp"

namespace {

constexpr double spawn_height = 10;  // m
constexpr double largest_distance = 1e-9;
constexpr double largest_ratio = 0.12;

struct Segment {
  int steps;
  double speeds[4];
};
/// Two seconds: up from rest, then tilted to and fro, so that every force has something to do.
constexpr Segment manoeuvre[] = {
    {1000, {480, -480, 480, -480}},
    {200, {477, -480, 483, -480}},
    {200, {483, -480, 477, -480}},
    {600, {480, -477, 480, -477}},
};

void fly(bare::Quadrotor& quadrotor) {
  for (const Segment& segment : manoeuvre) {
    quadrotor.command(segment.speeds);
    quadrotor.step(segment.steps);
  }
}

void fly(quadcore::Simulation& simulation) {
  for (const Segment& segment : manoeuvre) {
    simulation.command(segment.speeds, 4);
    simulation.step(segment.steps);
  }
}

template <typename Vehicle>
double seconds_per_step(Vehicle& vehicle) {
  int steps = 0;
  for (const Segment& segment : manoeuvre) steps += segment.steps;
  const double start = now();
  fly(vehicle);
  return (now() - start) / steps;
}

/// Largest difference of any component of the state, in SI units.
double distance(const bare::Quadrotor& quadrotor, const quadcore::VehicleState& state) {
  double largest = 0;
  const auto compare = [&largest](double a, double b) {
    const double difference = std::abs(a - b);
    if (!(difference <= largest)) largest = difference;  // NaN counts
  };
  const dBodyID frame = quadrotor.frame();
  const dReal *p = dBodyGetPosition(frame), *q = dBodyGetQuaternion(frame);
  const dReal *v = dBodyGetLinearVel(frame), *w_W = dBodyGetAngularVel(frame);
  dVector3 w;
  dBodyVectorFromWorld(frame, w_W[0], w_W[1], w_W[2], w);
  for (int i = 0; i < 3; ++i) {
    compare(p[i], state.position[i]);
    compare(v[i], state.linear_velocity[i]);
    compare(w[i], state.angular_velocity[i]);
    compare(q[1 + i], state.orientation.coeffs()[i]);
  }
  compare(q[0], state.orientation.w());
  for (int i = 0; i < 4; ++i) compare(quadrotor.rotor_rate(i), state.rotor_velocity[i]);
  return largest;
}

int compare(const char* urdf, int rounds) {
  using namespace quadcore;
  const Model model = read_model(Document::read(urdf));
  SimulationOptions options;
  options.spawn.xyz.z() = spawn_height;
  std::vector<double> bare_times, quadcore_times, ratios;
  double apart = 0;
  for (int round = 0; round < rounds; ++round) {
    // New ones in each round: where they happen to lie in memory averages out.
    bare::Quadrotor quadrotor(spawn_height);
    Simulation simulation(model, World{}, options);
    bare_times.push_back(seconds_per_step(quadrotor));
    quadcore_times.push_back(seconds_per_step(simulation));
    ratios.push_back(quadcore_times.back() / bare_times.back());
    apart = std::max(apart, distance(quadrotor, simulation.state()));
  }
  std::printf("bare ODE, us per step               %7.3f\n", 1e6 * quantile(bare_times, 0.5));
  std::printf("quadcore, us per step               %7.3f\n", 1e6 * quantile(quadcore_times, 0.5));
  std::printf("quadcore / bare ODE                 %7.3f   at most %.2f   (quartiles %.3f, %.3f)\n",
              quantile(ratios, 0.5), largest_ratio, quantile(ratios, 0.25), quantile(ratios, 0.75));
  std::printf("end states apart, SI units          %7.0e   at most %.0e\n", apart,
              largest_distance);
  return apart <= largest_distance ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    std::fprintf(stderr, "usage: %s quadrotor.urdf [ROUNDS]\n", argv[0]);
    return 2;
  }
  try {
    return compare(argv[1], argc == 3 ? std::max(1, std::atoi(argv[2])) : 201);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
}
