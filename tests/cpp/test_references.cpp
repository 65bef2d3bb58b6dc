#include <algorithm>
#include <cmath>

#include "ode/sdf_conversion.hpp"
#include "shapes.hpp"

using namespace quadcore;
using namespace quadcore::test;

TEST_CASE("a shape feels the tags of its own link, as Gazebo finds them by its name") {
  const auto tags = [](const std::string& name, const std::string& inside) {
    return "<gazebo reference=\"" + name + "\">" + inside + "</gazebo>\n";
  };
  const std::string body =
      shaped("base", shape(ball) + shape(ball, "", "named"), inertial("1", round_body)) +
      shaped("arm", shape(ball)) + joint("a", "fixed", "base", "arm") +
      shaped("base_foot", shape(ball)) + joint("b", "fixed", "base", "base_foot");
  const Model m = model(body + tags("base", "<mu1>0.5</mu1><kp value=\"1e6\"/>") +
                        tags("arm", "<mu1>0.25</mu1><fdir1>1 2 0</fdir1>") +
                        tags("base_foot", "<mu1>0.125</mu1>") + tags("arm", "<mu2>0.75</mu2>"));
  const std::vector<Collision>& shapes = m.links[0].collisions;
  REQUIRE(shapes.size() == 4);
  CHECK(shapes[0].surface.mu1 == 0.5);
  CHECK(shapes[0].surface.kp == 1e6);
  CHECK(shapes[0].surface.mu2 == 1);
  CHECK(shapes[1].surface.mu1 == 1);  // its name hides it
  CHECK(shapes[2].surface.mu1 == 0.25);
  CHECK(shapes[2].surface.mu2 == 0.75);
  CHECK(shapes[2].surface.fdir1 == Vector3d(1, 2, 0));
  CHECK(shapes[3].surface.mu1 == 0.5);  // its link's name begins with that of the base
  CHECK(m.warnings.size() == 3);
  for (const std::string& warning : m.warnings) CHECK(contains(warning, "as in Gazebo"));
}

TEST_CASE("of a body's references Gazebo takes the last for gravity and the first for damping") {
  const auto tags = [](const std::string& name, const std::string& inside) {
    return "<gazebo reference=\"" + name + "\">" + inside + "</gazebo>\n";
  };
  const std::string body = link("frame", 1, round_body) + "<link name=\"arm\"/>\n" +
                           joint("a", "fixed", "frame", "arm") + turning_rotor;
  const auto read = [&](const std::string& references) { return model(body + references); };
  const std::string both =
      "<turnGravityOff>true</turnGravityOff><dampingFactor>0.1</dampingFactor>";

  Model m = read(tags("frame", both));
  CHECK_FALSE(m.links[0].tags.gravity);
  CHECK(m.links[0].tags.damping_factor == 0.1);
  CHECK(m.links[1].tags.gravity);
  CHECK(m.warnings.empty());

  m = read(tags("frame", both) + tags("frame", "<mu1>1</mu1>"));
  CHECK(m.links[0].tags.gravity);
  CHECK(m.links[0].tags.damping_factor == 0.1);
  CHECK(contains(m.warnings.at(0), "turns gravity on again"));

  const std::string neither =
      "<turnGravityOff>false</turnGravityOff><dampingFactor>0</dampingFactor>";
  m = read(tags("frame", neither) + tags("arm", both));
  CHECK_FALSE(m.links[0].tags.gravity);
  CHECK(m.links[0].tags.damping_factor == 0);
  REQUIRE(m.warnings.size() == 1);
  CHECK(contains(m.warnings[0], "<dampingFactor>"));
  m = read(tags("frame", both) + tags("arm", neither));
  CHECK(m.links[0].tags.gravity);
  CHECK(m.links[0].tags.damping_factor == 0.1);
  REQUIRE(m.warnings.size() == 1);
  CHECK(contains(m.warnings[0], "<turnGravityOff>"));
  CHECK(read(tags("frame", neither) + tags("arm", neither)).warnings.empty());

  m = read(tags("arm", both) + tags("frame", "<material>Red</material>"));  // frame's come first
  CHECK_FALSE(m.links[0].tags.gravity);
  CHECK(m.links[0].tags.damping_factor == 0);
  CHECK(contains(m.warnings.at(0), "the first <gazebo reference>"));

  // What is at its default is not what an engine refuses.
  m = read(
      tags("rotor", "<turnGravityOff>true</turnGravityOff>\n<dampingFactor>0</dampingFactor>"));
  CHECK(contains(refusal([&] { make_engine("eigen", m, World{}); }), "test.urdf:7: link 'rotor'"));

  for (const std::string tag :
       {"<turnGravityOff>1</turnGravityOff>", "<dampingFactor>0.01</dampingFactor>"}) {
    const Model felt = read(tags("rotor", tag));
    const std::string message = refusal([&] { make_engine("eigen", felt, World{}); });
    CHECK(message.rfind("test.urdf:7: link 'rotor' has ", 0) == 0);
    make_engine("ode", felt, World{});
  }
}

TEST_CASE("a felt tag that names nothing that feels it, or has no such value, is refused") {
  const auto refused = [](const std::string& name, const std::string& inside) {
    return refusal([&] {
      model(link("frame", 1, round_body) + turning_rotor + "<gazebo reference=\"" + name + "\">" +
            inside + "</gazebo>\n");
    });
  };
  CHECK(contains(refused("fram", "<mu1>1</mu1>"),
                 "test.urdf:5: <mu1> applies to a link, but the model has no link 'fram'"));
  CHECK(contains(refused("fram", "<mu1>1</mu1>"), "Did you mean 'frame'?"));
  CHECK(contains(refused("turn", "<implicitSpringDamper>1</implicitSpringDamper><mu1>1</mu1>"),
                 "no link 'turn'. Name a link"));
  CHECK(contains(refused("turn", "<kp>1</kp>"), "no link 'turn'. Name a link"));
  CHECK(contains(refused("frame", "<implicitSpringDamper>1</implicitSpringDamper>"),
                 "no joint 'frame'"));
  CHECK(contains(refused("frame", "<mu1>-1</mu1>"), "<mu1> is '-1'. Use >= 0"));
  CHECK(contains(refused("frame", "<kp>0</kp>"), "<kp> is '0'. Use > 0"));
  CHECK(contains(refused("frame", "<kp>nan</kp>"), "<kp> is 'nan'"));
  CHECK(contains(refused("frame", "<maxContacts>1.5</maxContacts>"), "whole number >= 1"));
  CHECK(contains(refused("frame", "<fdir1>1 0</fdir1>"), "Use three numbers"));
  CHECK(contains(refused("frame", "<turnGravityOff>maybe</turnGravityOff>"), "true | false"));
  CHECK(contains(refused("frame", "<gravity>0</gravity>"), "<gravity> is '0'. Use true"));
  CHECK(contains(refused("turn", "<springStiffness>1</springStiffness>"), "Use 0"));
  CHECK(contains(refused("frame", "<mu3>1</mu3>"), "Did you mean 'mu1'?"));
  model(link("frame", 1, round_body) + turning_rotor +
        "<gazebo reference=\"nobody\"><material>Red</material></gazebo>\n");
}

TEST_CASE("damping takes its part of what is faster than 1 cm/s or 0.01 rad/s, each by itself") {
  const Model m = model(link("frame", 1, round_body) +
                        "<gazebo reference=\"frame\"><dampingFactor>0.25</dampingFactor></gazebo>");
  World weightless;
  weightless.gravity_W.setZero();
  for (const char* name : {"gazebo11", "ode"}) {
    for (const double v : {0.01, 0.011}) {
      for (const double w : {0.01, 0.011}) {
        const auto engine = make_engine(name, m, weightless);
        VehicleState state;
        engine->get_state(state);
        state.linear_velocity = {0, -v, 0};
        state.angular_velocity = {0, 0, w};
        engine->set_state(state);
        engine->step(0, 1e-3, NoForces());
        engine->get_state(state);
        CHECK(state.linear_velocity.y() == doctest::Approx(v > 0.01 ? -0.75 * v : -v));
        CHECK(state.angular_velocity.z() == doctest::Approx(w > 0.01 ? 0.75 * w : w));
      }
    }
  }
}

TEST_CASE("tags are rounded to six digits, a direction to six decimals") {
  const Model m =
      model(shaped("frame", shape(ball), inertial("1", round_body)) + turning_rotor +
            "<gazebo reference=\"frame\"><mu1>0.12345678</mu1><kp>1234567.8</kp><fdir1>0.12345678 "
            "0 1234.56789</fdir1></gazebo>\n");
  CHECK(m.links[0].collisions[0].surface.mu1 == 0.12345678);
  const Surface surface = converted_to_sdf(m).links[0].collisions[0].surface;
  CHECK(surface.mu1 == 0.123457);
  CHECK(surface.kp == 1234570);
  CHECK(surface.fdir1 == Vector3d(0.123457, 0, 1234.57));
}

TEST_CASE("dry friction takes its torque from a joint, step after step, and holds it in the end") {
  std::string turning = turning_rotor;
  turning.insert(turning.find("</joint>"), "<dynamics friction=\"4e-5\"/>");
  const Model m = model(link("frame", 1, skew_body) + turning);
  for (const int iterations : {5, 50}) {  // Gazebo's sweeps, and what they converge to
    World world;
    world.solver_iterations = iterations;
    for (const char* name : {"gazebo11", "ode"}) {
      CAPTURE(name);
      const auto engine = make_engine(name, m, world);
      VehicleState state;
      state.rotor_velocity = VectorXd::Constant(1, 0.021);
      state.rotor_angle = VectorXd::Constant(1, 0.3);
      engine->set_state(state);
      for (int i = 1; i <= 15; ++i) {
        engine->step(0, 1e-3, NoForces());
        // 2e-5 kg m^2, and the frame is heavy.
        const double rate = std::max(0.0, 0.021 - 2e-3 * i);
        const Kinematics& k = engine->kinematics();
        CHECK(std::abs(k.rotors[0].rate - rate) < 2e-4);
        // The frame gets what the rotor loses.
        const double spin =
            (m.links[0].inertial.inertia * k.w_WF_F).z() + 2e-5 * (k.w_WF_F.z() + k.rotors[0].rate);
        CHECK(spin == doctest::Approx(2e-5 * 0.021).epsilon(1e-3));
      }
    }
  }
}

TEST_CASE("implicit damping slows a joint wherever it stands") {
  std::string turning = turning_rotor;
  turning.insert(turning.find("</joint>"), "<dynamics damping=\"0.002\"/>");
  const Model m = model(
      link("frame", 1, skew_body) + turning +
      "<gazebo reference=\"turn\"><implicitSpringDamper>true</implicitSpringDamper></gazebo>");
  World swept;
  swept.solver_iterations = 5;
  for (const auto& [name, world] :
       {std::pair("gazebo11", World{}), std::pair("ode", World{}), std::pair("gazebo11", swept)}) {
    CAPTURE(name);
    const auto engine = make_engine(name, m, world);
    VehicleState state;
    state.rotor_velocity = VectorXd::Zero(1);
    state.rotor_angle = VectorXd::Constant(1, 1.3);
    engine->set_state(state);
    engine->step(0, 1e-3, NoForces());
    CHECK(std::abs(engine->kinematics().rotors[0].rate) < 1e-9);  // nothing pulls it back
    state.rotor_velocity[0] = 10;
    engine->set_state(state);
    engine->step(0, 1e-3, NoForces());
    // 0.002 * 1e-3 / 2e-5 = 0.1 of the rate at the end of the step; the frame is heavy.
    CHECK(engine->kinematics().rotors[0].rate == doctest::Approx(10 / 1.1).epsilon(1e-3));
  }
}
