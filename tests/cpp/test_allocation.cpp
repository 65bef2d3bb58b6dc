#include <cstdlib>
#include <new>

#include "quadcore/plugin_library.hpp"
#include "shapes.hpp"

using namespace quadcore;
using namespace quadcore::test;

namespace {

long allocations = 0;

}  // namespace

// The library's own go through here as well: by new, and Eigen's by malloc.
void* operator new(std::size_t size) {
  ++allocations;
  if (void* const memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  ++allocations;
  const auto step = static_cast<std::size_t>(alignment);
  if (void* const memory = std::aligned_alloc(step, (size + step - 1) / step * step)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

#ifndef __SANITIZE_ADDRESS__
extern "C" {
void* __libc_malloc(std::size_t size);
void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
}
#endif

TEST_CASE("steps allocate nothing, in the air or on the ground") {
  const Model m = model(shaped("frame", shape("<box size=\"0.3 0.2 0.1\"/>"),
                               inertial("1", skew_body, "xyz=\"0.01 -0.02 0.03\"")) +
                        turning_rotor);
  for (const EngineInfo& info : engines()) {
    for (const bool grounded : {false, true}) {
      CAPTURE(info.name);
      CAPTURE(grounded);
      World world;
      world.ground_plane = grounded;
      const auto engine = make_engine(info.name, m, world);
      VehicleState state;
      state.position.z() = 0.06;
      state.angular_velocity = {0.3, -0.2, 0.5};
      state.rotor_velocity = VectorXd::Constant(1, 40);
      state.rotor_angle = VectorXd::Constant(1, 0.3);
      engine->set_state(state);
      const NoForces none;
      engine->step(0, 1e-3, none);  // ODE takes its working memory
      const long before = allocations;
      for (int i = 0; i < 200; ++i) engine->step(0, 1e-3, none);
      CHECK(allocations == before);
      CHECK((engine->kinematics().p_WF.z() < -0.1) == !grounded);
    }
  }
}

TEST_CASE("steps with every hook allocate only where what is carried changes") {
  load_plugin_path(TEST_PLUGINS);
  const Model m = model(link("frame", 1, skew_body) + turning_rotor +
                        "<gazebo><plugin name=\"laden\" filename=\"libladen_plugin.so\">"
                        "<until>0.0495</until></plugin></gazebo>");
  for (const EngineInfo& info : engines()) {
    CAPTURE(info.name);
    SimulationOptions options;
    options.engine = info.name;
    Simulation flown(m, World{}, options);
    const double laden = mass_properties(flown.model()).mass;
    const auto allocated_in = [&flown](std::int64_t steps) {
      const long before = allocations;
      flown.step(steps);
      return allocations - before;
    };
    flown.step();  // ODE takes its working memory
    CHECK(allocated_in(48) == 0);
    CHECK(mass_properties(flown.model()).mass == laden);
    CHECK(allocated_in(2) > 0);  // it is let go, and ODE takes memory anew
    CHECK(mass_properties(flown.model()).mass == doctest::Approx(laden - 0.2));
    CHECK(allocated_in(50) == 0);
    flown.reset(7);
    CHECK(mass_properties(flown.model()).mass == laden);
  }
}

TEST_CASE("steps with everything that disturbs and measures allocate nothing") {
  const std::pair<const char*, const char*> plugins[] = {
      {"aerodynamic",
       "<rotorThrustCoeff>1e-5</rotorThrustCoeff><rotorTorqueCoeff>1e-7</rotorTorqueCoeff>"
       "<dragModel>chapter2</dragModel><parasiticDragCoeff>0.01</parasiticDragCoeff>"},
      {"motor", "<delay>0.003</delay><maxVelocity>900</maxVelocity>"},
      {"wind",
       "<velocity>3 1 0</velocity><shear>power</shear><turbulence>15</turbulence>"
       "<gusts>2 0 0 0.01 0.05</gusts>"},
      {"payload", "<mass>0.1</mass>"},
      {"push", "<pushes>0.02 0.05 1 0 0 0 0 0.1</pushes>"},
      {"fault", "<losses>0.02 1 0.5</losses><cuts>0.05 1</cuts><detection>0.01</detection>"},
      {"ground_effect", ""},
      {"odometry",
       "<positionNoise>0.1</positionNoise><positionWalk>0.1</positionWalk>"
       "<positionResolution>0.01</positionResolution><delay>0.01</delay>"},
      {"imu", "<gyroNoise>0.01</gyroNoise><gyroWalk>0.1</gyroWalk><delay>0.007</delay>"},
      {"gps", "<horizontalNoise>1</horizontalNoise><rate>100</rate><dropout>0.3</dropout>"},
  };
  std::string urdf = link("frame", 1, skew_body) + turning_rotor;
  for (const auto& [name, tags] : plugins) {
    urdf += "<gazebo><plugin name=\"" + std::string(name) + "\" filename=\"lib" + name +
            "_plugin.so\">" + tags + "</plugin></gazebo>";
  }
  World world;
  world.ground_plane = true;
  for (const EngineInfo& info : engines()) {
    CAPTURE(info.name);
    SimulationOptions options;
    options.engine = info.name;
    options.spawn.xyz.z() = 20;
    Simulation flown(model(urdf), world, options);
    const double speed = 400;
    flown.command(&speed, 1);
    flown.step();  // ODE takes its working memory
    const long before = allocations;
    flown.step(199);
    CHECK(allocations == before);
  }
}
