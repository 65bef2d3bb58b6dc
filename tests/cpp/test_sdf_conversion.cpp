#include <algorithm>
#include <cmath>

#include "ode/sdf_conversion.hpp"
#include "ode/sdf_numbers.hpp"
#include "shapes.hpp"

using namespace quadcore;
using namespace quadcore::test;

namespace {

/// Odd rotations everywhere: pitch near 90 degrees in a joint and in an inertial, an inertial with
/// axes of its own in the link that carries all, names in another order than the file.
const std::string odd =
    shaped(
        "frame",
        shape("<box size=\"0.12345678 0.2 0.0333333333\"/>", "xyz=\"0 0 -0.01\" rpy=\"3 2.2 0.1\""),
        inertial("1.2", skew_body, "xyz=\"0.01 -0.02 0.03\" rpy=\"0.1 0.2 0.3\"")) +
    shaped(
        "z_arm",
        shape("<cylinder radius=\"0.012345678\" length=\"0.1\"/>",
              "xyz=\"0.1 0 0\" rpy=\"0.3 0 0.2\""),
        inertial(
            "0.3",
            "ixx=\"0.0002\" iyy=\"0.0003\" izz=\"0.00025\" ixy=\"1e-5\" ixz=\"2e-5\" iyz=\"-3e-5\"",
            "xyz=\"0.05 0.02 0.1\" rpy=\"0.4 1.5668 -0.7\"")) +
    joint("b_weld", "fixed", "frame", "z_arm", "xyz=\"0.1 0.05 0.02\" rpy=\"0.2 1.5668 0.5\"") +
    shaped(
        "a_foot", shape(ball),
        inertial("0.1", "ixx=\"1e-4\" iyy=\"2e-4\" izz=\"1.5e-4\" ixy=\"0\" ixz=\"0\" iyz=\"1e-5\"",
                 "xyz=\"0 0.02 -0.05\"")) +
    joint("a_weld", "fixed", "z_arm", "a_foot", "xyz=\"-0.1 0.3 0.2\" rpy=\"-0.7 0.5 -2\"") +
    shaped("c_foot", shape("<sphere radius=\"0.03\"/>", "xyz=\"0.01 0.02 0.03\"")) +
    joint("a_foot", "fixed", "frame", "c_foot", "xyz=\"0.2 0.3 -0.1\" rpy=\"0.1 0.2 0.3\"") +
    link("rotor", 0.01, round_rotor) +
    joint("turn", "continuous", "a_foot", "rotor", "xyz=\"0.01 0.02 0.05\" rpy=\"0.1 0 0\"");

std::string locked(const std::string& name, const std::string& parent, const std::string& child,
                   const std::string& origin = "xyz=\"0 0 0\"", const std::string& axis = "0 0 1") {
  return "<joint name=\"" + name + "\" type=\"revolute\"><parent link=\"" + parent +
         "\"/><child link=\"" + child + "\"/><origin " + origin + "/><axis xyz=\"" + axis +
         "\"/><limit lower=\"0\" upper=\"0\" effort=\"1\" velocity=\"1\"/></joint>\n";
}

Vector3d rounded_rpy(double roll, double pitch, double yaw) {
  return sdf_pose(SdfPose(Pose{{0, 0, 0}, {roll, pitch, yaw}})).rpy;
}

}  // namespace

// The numbers below are those of libsdformat 12.3, rounded to 6 decimals and digits by hand.
TEST_CASE("a body is lumped as sdformat lumps it, rounded along the axes of its own inertial") {
  const Model sdf = converted_to_sdf(model(odd));
  const Inertial& frame = sdf.links[0].inertial;
  CHECK(frame.mass == 1.6);
  CHECK(frame.pose.xyz == Vector3d(0.05251, 0.029137, 0.024699));
  CHECK(frame.pose.rpy == Vector3d(0.1, 0.2, 0.3));
  CHECK(frame.inertia(0, 0) == 0.0273342);
  CHECK(frame.inertia(0, 1) == -0.0093626);
  CHECK(frame.inertia(0, 2) == -0.0011154);
  CHECK(frame.inertia(1, 1) == 0.0303273);
  CHECK(frame.inertia(1, 2) == -0.00338681);
  CHECK(frame.inertia(2, 2) == 0.0497549);
  CHECK(sdf.joints[0].pose.xyz == Vector3d(0.230327, 0.363667, 0.086571));
  CHECK(sdf.joints[0].pose.rpy == Vector3d(-1.95164, -0.371152, -1.81295));
}

TEST_CASE("lumped shapes come by the names of their joints, a link's own first") {
  const Model sdf = converted_to_sdf(model(odd));
  const std::vector<Collision>& shapes = sdf.links[0].collisions;
  REQUIRE(shapes.size() == 4);
  CHECK(shapes[0].size == Vector3d(0.123457, 0.2, 0.033333));
  CHECK(shapes[0].pose.xyz == Vector3d(0, 0, -0.01));
  CHECK(shapes[0].pose.rpy == Vector3d(-0.141593, 0.941593, -3.04159));
  CHECK(shapes[1].size.x() == 0.03);
  CHECK(shapes[1].pose.xyz == Vector3d(0.210412, 0.320916, -0.070775));
  CHECK(shapes[2].size == Vector3d(0.0123457, 0.1, 1));
  CHECK(shapes[2].pose.xyz == Vector3d(0.100351, 0.050192, -0.079999));
  CHECK(shapes[2].pose.rpy == Vector3d(1.85116, 1.36997, 1.85155));
  CHECK(shapes[3].size.x() == 0.02);
  CHECK(shapes[3].pose.xyz == Vector3d(0.202059, 0.395512, 0.121021));
}

TEST_CASE("the names of the links that are lumped stay known, and the exact numbers too") {
  const Model exact = model(odd), sdf = converted_to_sdf(exact);
  CHECK(exact.name == "test");
  CHECK(sdf.name == "test");
  CHECK(sdf.body_of_link == exact.body_of_link);
  CHECK(sdf.pose_of_link.size() == exact.links.size() + 3);
  const Pose& foot = exact.pose_of_link.at("a_foot");
  CHECK((foot.xyz - (Vector3d(0.1, 0.05, 0.02) +
                     quaternion_from_rpy({0.2, 1.5668, 0.5}) * Vector3d(-0.1, 0.3, 0.2)))
            .norm() < 1e-13);
  CHECK(make_engine("ode", exact, World{})->model().links[0].inertial.pose.xyz ==
        exact.links[0].inertial.pose.xyz);
}

TEST_CASE(
    "a scalar keeps six digits; a component six decimals, ties away from zero, then six digits") {
  CHECK(sdf_scalar(1234.5678) == 1234.57);
  CHECK(sdf_scalar(1.23456789e-9) == 1.23457e-9);
  CHECK(sdf_vector({123.4567891, 1.23456789e-5, -4e-7}) == Vector3d(123.457, 1.2e-5, 0));
  CHECK(sdf_vector({0.0338985, -0.0338985, 0.0000005}) == Vector3d(0.033899, -0.033899, 1e-6));
  CHECK(sdf_vector({0.0012345, 0.1234565, 0.0000025}) == Vector3d(0.001235, 0.123457, 3e-6));
}

TEST_CASE("a box that rounding makes flat is refused") {
  const auto boxed = [](const std::string& size) {
    return model(shaped("frame", shape("<box size=\"" + size + "\"/>"), inertial("1", round_body)) +
                 turning_rotor);
  };
  converted_to_sdf(boxed("0.1 0.000002 0.1"));
  CHECK(
      contains(refusal([&] { converted_to_sdf(boxed("0.1 0.0000004 0.1")); }), "the box is flat"));
}

TEST_CASE("a rotation passes through a quaternion, and at 90 degrees of pitch all yaw is roll") {
  CHECK(rounded_rpy(3, 2.2, 0.1) == Vector3d(-0.141593, 0.941593, -3.04159));
  CHECK(rounded_rpy(0.3, M_PI_2, 0.1) == Vector3d(0.2, 1.5708, 0));
  CHECK(rounded_rpy(0.3, -M_PI_2, 0.1) == Vector3d(0.4, -1.5708, 0));
  CHECK(rounded_rpy(0.3, M_PI_2 - 3e-8, 0.1) == Vector3d(0.2, 1.5708, 0));
  CHECK(rounded_rpy(0.3, M_PI_2 - 5.5e-8, 0.1) == Vector3d(0.3, 1.5708, 0.1));
  CHECK(rounded_rpy(0, 1.5668, 0.5) == Vector3d(0, 1.5668, 0.5));
  // Shapes pass through urdfdom's angles, which are coarse there.
  CHECK(sdf_shape_pose(SdfPose(Pose{{0, 0, 0}, {0, 1.5668, 0.5}})).rpy ==
        Vector3d(-0.5, 1.5708, 0));
  CHECK(sdf_shape_pose(SdfPose(Pose{{0, 0, 0}, {0.3, M_PI_2, 0.1}})).rpy ==
        Vector3d(0.2, 1.5708, 0));
  CHECK(sdf_shape_pose(SdfPose(Pose{{0, 0, 0}, {0.3, -M_PI_2, 0.1}})).rpy ==
        Vector3d(0.4, -1.5708, 0));
}

TEST_CASE("a rotor that Gazebo loses is refused by the engine that is Gazebo, with a remedy") {
  const auto vehicle = [](const std::string& mount) {
    return model(link("frame", 1, round_body) + mount +
                 joint("weld", "fixed", "frame", "mount", "xyz=\"0.1 0 0\"") +
                 link("rotor", 0.01, round_rotor) + joint("turn", "continuous", "mount", "rotor"));
  };
  const auto mass = [](const std::string& kg) {
    return shaped("mount", "", inertial(kg, round_rotor));
  };
  for (const std::string& lost : {shaped("mount", ""), mass("9.9e-7")}) {
    const Model m = vehicle(lost);
    const std::string message = refusal([&] { make_engine("gazebo11", m, World{}); });
    CHECK(message.rfind("test.urdf:3: link 'mount', including the links fixed to it, has", 0) == 0);
    CHECK(contains(message, "'turn'"));
    CHECK(contains(message, "use the engine ode or eigen"));
    make_engine("ode", m, World{});
    make_engine("eigen", m, World{});
  }
  make_engine("gazebo11", vehicle(mass("1.1e-6")), World{});
}

TEST_CASE("a rotor of no more than 1e-6 kg is lost too, but not what is fixed to a heavier one") {
  const auto vehicle = [](const std::string& kg, const std::string& fixed_to_it) {
    return model(link("frame", 1, round_body) + shaped("rotor", "", inertial(kg, round_rotor)) +
                 joint("turn", "continuous", "frame", "rotor") + fixed_to_it);
  };
  const std::string message =
      refusal([&] { make_engine("gazebo11", vehicle("9e-7", ""), World{}); });
  CHECK(contains(message, "link 'rotor', including"));
  CHECK(contains(message, "'turn'"));
  make_engine("gazebo11",
              vehicle("0.01", shaped("mark", "") + joint("weld", "fixed", "rotor", "mark")),
              World{});
}

TEST_CASE("mounts that carry nothing that turns, or something heavy, may be massless") {
  const std::string heavy_end =
      "<link name=\"arm\"/>\n" + link("end", 0.2, round_rotor) +
      joint("a", "fixed", "frame", "arm") + joint("b", "fixed", "arm", "end") +
      "<link name=\"mark\"/>\n" + joint("c", "fixed", "frame", "mark") +
      link("rotor", 0.01, round_rotor) + joint("turn", "continuous", "arm", "rotor");
  CHECK(converted_to_sdf(model(link("frame", 1, round_body) + heavy_end)).links[0].inertial.mass ==
        1.2);
}

TEST_CASE("a locked joint is fixed, and the link behind it is rounded by itself") {
  const std::string weld = locked("weld", "frame", "sensor", "xyz=\"0.1234567 0 0\"");
  const Model m =
      model(shaped("frame", "", inertial("1.0000001", round_body)) +
            shaped("sensor", "", inertial("0.1000004", round_rotor, "xyz=\"0 0 0.0000004\"")) +
            weld + turning_rotor);
  REQUIRE(m.links.size() == 2);
  CHECK(m.body_of_link.at("sensor") == 0);
  CHECK(m.pose_of_link.at("sensor").xyz == Vector3d(0.1234567, 0, 0));
  CHECK(m.links[0].inertial.mass == doctest::Approx(1.1000005).epsilon(1e-15));
  const Model sdf = converted_to_sdf(m);
  REQUIRE(sdf.links.size() == 2);
  CHECK(sdf.pose_of_link.at("sensor").xyz == Vector3d(0.123457, 0, 0));
  CHECK(sdf.links[0].inertial.mass == 1 + 0.1);  // 1.1000005 would have become 1.1 or 1.10001
  CHECK(sdf.links[0].inertial.pose.xyz.x() == doctest::Approx(0.1 * 0.123457 / 1.1).epsilon(1e-15));
  CHECK(sdf.links[0].inertial.pose.xyz.z() == 0);
}

TEST_CASE("a link behind a locked joint needs no mass where nothing hangs on it") {
  const std::string weld = locked("weld", "frame", "mark", "xyz=\"0.1 0 0\"");
  for (const std::string& mark :
       {shaped("mark", ""), shaped("mark", "", inertial("9e-7", round_rotor))}) {
    const Model m = model(link("frame", 1, round_body) + mark + weld + turning_rotor);
    CHECK(converted_to_sdf(m).links[0].inertial.mass == 1);
    CHECK(sdf_bodies(m).model.links.size() == 2);
    CHECK(sdf_bodies(m).model.warnings.empty());
  }
}

TEST_CASE("Gazebo makes a body of a link behind a locked joint, with what is fixed to the link") {
  const Model m = model(link("frame", 1, round_body) + link("mast", 0.1, round_body) +
                        link("tip", 0.2, round_body) + link("eye", 0.1, round_rotor) +
                        link("second", 0.1, round_rotor) + turning_rotor +
                        joint("z", "continuous", "tip", "second") + locked("a", "second", "eye") +
                        locked("weld", "frame", "mast", "xyz=\"0.1234567 0 0\"", "0 3 4") +
                        joint("glue", "fixed", "mast", "tip", "xyz=\"0 0 1\""));
  const Bodies bodies = sdf_bodies(m);
  const Model& b = bodies.model;
  std::vector<std::string> rotors, names;
  for (const std::size_t i : bodies.rotors) rotors.push_back(b.joints[i].name);
  CHECK(rotors == m.joint_names());
  for (const std::size_t i : sdf_order(b)) names.push_back(b.links[i].name);
  CHECK(names == std::vector<std::string>{"frame", "rotor", "mast", "second", "eye"});
  const auto weld = std::find_if(b.joints.begin(), b.joints.end(),
                                 [](const Joint& joint) { return joint.name == "weld"; });
  REQUIRE(weld != b.joints.end());
  CHECK(bodies.is_locked(static_cast<std::size_t>(weld - b.joints.begin())));
  CHECK(weld->pose.xyz == Vector3d(0.123457, 0, 0));
  CHECK((weld->axis - Vector3d(0, 0.6, 0.8)).norm() < 1e-15);
  const Link& mast = b.links[static_cast<std::size_t>(weld - b.joints.begin()) + 1];
  CHECK(mast.name == "mast");
  CHECK(mast.inertial.mass == doctest::Approx(0.3).epsilon(1e-15));
  CHECK(b.links[0].inertial.mass == 1);
}

TEST_CASE("a locked joint needs an axis in Gazebo alone") {
  const Model m = model(link("frame", 1, round_body) + link("eye", 0.1, round_rotor) +
                        locked("weld", "frame", "eye", "xyz=\"0 0 0\"", "0 0 0"));
  CHECK(m.links.size() == 1);
  CHECK(contains(refusal([&] { sdf_bodies(m); }), "joint 'weld': after rounding to 6 decimals"));
}

TEST_CASE("a link behind a locked joint that no torque can turn stays lumped, with a warning") {
  const Model m =
      model(link("frame", 1, round_body) +
            link("eye", 0.1, "ixx=\"0\" ixy=\"0\" ixz=\"0\" iyy=\"0\" iyz=\"0\" izz=\"0\"") +
            locked("weld", "frame", "eye") + turning_rotor);
  const Bodies bodies = sdf_bodies(m);
  CHECK(bodies.model.links.size() == 2);
  REQUIRE(bodies.model.warnings.size() == 1);
  CHECK(contains(bodies.model.warnings[0], "link 'eye' behind the locked joint 'weld' has a zero"));
}
