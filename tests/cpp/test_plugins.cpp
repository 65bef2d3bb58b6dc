#include <cstdlib>

#include "quadcore/plugin_library.hpp"
#include "vehicle.hpp"

using namespace quadcore;
using namespace quadcore::test;

extern "C" {
__attribute__((weak)) void __lsan_disable();
__attribute__((weak)) void __lsan_enable();
}

namespace {

/// ODE leaks the memory of a step that it gave up; a leak checker, if there is one, looks away.
struct LeaksAllowed {
  LeaksAllowed() {
    if (__lsan_disable) __lsan_disable();
  }
  ~LeaksAllowed() {
    if (__lsan_enable) __lsan_enable();
  }
};

void find_test_plugins() {
  static const bool added = [] { return load_plugin_path(TEST_PLUGINS), true; }();
  REQUIRE(added);
}

Simulation simulation(const std::string& plugin, const std::string& tags = "",
                      const std::string& engine = "gazebo11", bool ground = false) {
  find_test_plugins();
  const Model m =
      model(link("frame", 1, round_body) + link("rotor", 0.01, round_rotor) +
            joint("turn", "continuous", "frame", "rotor") + "<gazebo><plugin name=\"it\" " +
            "filename=\"lib" + plugin + "_plugin.so\">" + tags + "</plugin></gazebo>\n" +
            "<link name=\"foot\"><collision><geometry><sphere radius=\"0.1\"/></geometry>" +
            "</collision></link>" + joint("weld", "fixed", "frame", "foot"));
  World world;
  world.ground_plane = ground;
  SimulationOptions options;
  options.engine = engine;
  options.spawn.xyz.z() = ground ? 0.1 : 10;
  return Simulation(m, world, options);
}

std::string failure(Simulation& flown, std::int64_t steps) {
  try {
    flown.step(steps);
  } catch (const FlightError& error) {
    return error.what();
  }
  FAIL("the flight went on");
  return "";
}

}  // namespace

TEST_CASE("a plugin of another interface is refused") {
  const std::string message = refusal([] { simulation("other_abi"); });
  CHECK(message.rfind("test.urdf:5: plugin 'it': libother_abi_plugin.so in ", 0) == 0);
  CHECK(contains(message, TEST_PLUGINS));
  CHECK(contains(message, " was built for plugin interface of tomorrow, but this quadcore has "));
  CHECK(contains(message, "Rebuild it against the installed quadcore"));
}

TEST_CASE("a plugin that throws while it is made is named with its file") {
  const std::string message = refusal([] { simulation("throwing", "<hook>create</hook>"); });
  CHECK(message.rfind("test.urdf:5: plugin 'it' (" TEST_PLUGINS "/libthrowing_plugin.so)", 0) == 0);
  CHECK(contains(message, "no luck"));
}

TEST_CASE("a plugin that throws in flight is named, and the simulation can be taken up again") {
  for (const std::string hook : {"update", "sense", "forces", "number"}) {
    CAPTURE(hook);
    Simulation flown = simulation("throwing", "<hook>" + hook + "</hook><after>0.0105</after>");
    const std::string message = failure(flown, 100);
    CHECK(message.rfind("the flight failed at t = 0.01", 0) == 0);
    CHECK(contains(message, "plugin 'it' (" TEST_PLUGINS "/libthrowing_plugin.so): "));
    CHECK(contains(message, hook == "number" ? "not a std::exception" : "no luck"));
    CHECK(flown.time() < 0.0125);
    CHECK(contains(failure(flown, 1), "To continue, call reset, restore or set_state."));
    flown.reset();
    flown.step(10);
    CHECK(flown.time() == doctest::Approx(0.01));
    CHECK(flown.state().position.z() == doctest::Approx(10 - 9.8 * 0.01 * 0.011 / 2));
  }
}

TEST_CASE("what a library with hidden symbols throws keeps its type on the way out") {
  Simulation flown = simulation("throwing", "<hook>input</hook><after>0.5</after>");
  VehicleState later = flown.state();
  later.time = 1;
  CHECK(refusal([&] { flown.set_state(later); }) == "no luck");
}

TEST_CASE("a description that a plugin ends by an error leaves the vehicle where it is") {
  for (const EngineInfo& info : engines()) {
    CAPTURE(info.name);
    const std::string tags = "<hook>probe</hook><after>0.0105</after>";
    Simulation probed = simulation("throwing", tags, info.name);
    Simulation other = simulation("throwing", tags, info.name);
    probed.step(20);
    other.step(20);
    CHECK(refusal([&] { probed.describe_vehicle(); }) == "no luck");
    CHECK(probed.snapshot().engine == other.snapshot().engine);
    probed.step(5);
    other.step(5);
    CHECK(probed.state().position == other.state().position);
  }
}

TEST_CASE("a torque beyond all bounds ends the flight, and the simulation can be taken up again") {
  const LeaksAllowed allowed;
  const auto fly = [](const std::string& hook, const std::string& engine, bool ground) {
    CAPTURE(hook);
    CAPTURE(engine);
    CAPTURE(ground);
    Simulation flown =
        simulation("throwing", "<hook>" + hook + "</hook><after>0.0105</after>", engine, ground);
    Simulation other = simulation("throwing", "", engine, ground);
    failure(flown, 100);
    CHECK(flown.time() < 0.0135);
    flown.reset();
    flown.step(10);
    other.step(10);
    CHECK(flown.state().position == other.state().position);
    CHECK(flown.state().orientation.coeffs() == other.state().orientation.coeffs());
    CHECK(flown.state().rotor_velocity == other.state().rotor_velocity);
  };
  for (const char* hook : {"nan", "huge"}) {
    for (const EngineInfo& info : engines()) fly(hook, info.name, false);
    fly(hook, "gazebo11", true);
    fly(hook, "ode", true);
  }
}

TEST_CASE("a plugin without bounds is updated in each step beside one that states bounds") {
  find_test_plugins();
  const std::string plugins =
      "<gazebo><plugin name=\"counts\" filename=\"libcounting_plugin.so\"/>"
      "<plugin name=\"bounded\" filename=\"libbounded_plugin.so\"/></gazebo>\n";
  const Model m = model(link("frame", 1, round_body) + link("rotor", 0.01, round_rotor) +
                        joint("turn", "continuous", "frame", "rotor") + plugins);
  for (const EngineInfo& info : engines()) {
    CAPTURE(info.name);
    SimulationOptions options;
    options.engine = info.name;
    Simulation flown(m, World{}, options);
    flown.step(7);
    CHECK(flown.snapshot().plugin_state[0] == 7);
  }
}

TEST_CASE("folders are searched newest first, then the environment's, then the core's own") {
  setenv("QUADCORE_PLUGIN_PATH", "/nowhere::/elsewhere", 1);
  load_plugin_path(TEST_DATA);
  const std::vector<std::string> folders = plugin_folders();
  unsetenv("QUADCORE_PLUGIN_PATH");
  REQUIRE(folders.size() >= 4);
  CHECK(folders.front() == TEST_DATA);
  CHECK(folders[folders.size() - 3] == "/nowhere");
  CHECK(folders[folders.size() - 2] == "/elsewhere");
}
