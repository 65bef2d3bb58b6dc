#include <Eigen/Eigenvalues>
#include <cmath>

#include "ode/sdf_conversion.hpp"
#include "vehicle.hpp"

using namespace quadcore;
using namespace quadcore::test;

namespace {

struct PointMass {
  double mass;
  Vector3d place;
};

/// Six points that have the mass, the centre and the inertia of a body which stands at `pose`.
std::vector<PointMass> points_of(const Inertial& inertial, const Pose& pose) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> principal(inertial.inertia);
  const Matrix3d R = (pose.rotation() * inertial.pose.rotation()).toRotationMatrix();
  const Vector3d center = pose.xyz + pose.rotation() * inertial.pose.xyz;
  const Vector3d moments = principal.eigenvalues();
  std::vector<PointMass> points;
  for (int i = 0; i < 3; ++i) {
    // 2 (m/6) a_i^2 is the integral of x_i^2 dm, half of I_j + I_k - I_i.
    const double square = 1.5 * (moments.sum() - 2 * moments[i]) / inertial.mass;
    const Vector3d arm = R * principal.eigenvectors().col(i) * std::sqrt(square);
    points.push_back({inertial.mass / 6, center + arm});
    points.push_back({inertial.mass / 6, center - arm});
  }
  return points;
}

/// What a body made of points has, straight from the definitions.
MassProperties sum_of(const std::vector<PointMass>& points) {
  MassProperties sum;
  for (const PointMass& p : points) {
    sum.mass += p.mass;
    sum.p_FCcm += p.mass * p.place;
  }
  sum.p_FCcm /= sum.mass;
  for (const PointMass& p : points) {
    const Vector3d d = p.place - sum.p_FCcm;
    sum.inertia_Ccm_F += p.mass * (d.squaredNorm() * Matrix3d::Identity() - d * d.transpose());
  }
  return sum;
}

void check_same(const MassProperties& a, const MassProperties& b) {
  CHECK(a.mass == doctest::Approx(b.mass).epsilon(1e-14));
  CHECK((a.p_FCcm - b.p_FCcm).norm() < 1e-14);
  CHECK((a.inertia_Ccm_F - b.inertia_Ccm_F).norm() < 1e-14);
}

std::vector<PointMass> operator+(std::vector<PointMass> a, const std::vector<PointMass>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

Inertial inertial_of(const std::string& text) { return model(text).links[0].inertial; }

}  // namespace

TEST_CASE("links on fixed joints become one body with the inertia of their points") {
  const std::string frame =
      link("frame", 1, skew_body, "xyz=\"0.01 -0.02 0.03\" rpy=\"0.1 0.2 0.3\"");
  const std::string arm = link("arm", 0.3, round_body, "xyz=\"0.1 0 0\" rpy=\"1 -0.5 0.2\"");
  const std::string tip = link("tip", 0.1, skew_body, "xyz=\"0 0.05 0.01\" rpy=\"-1 0.4 2\"");
  const Pose frame_arm{{0.2, 0.1, -0.1}, {0.3, -0.2, 1.5}};
  const Pose arm_tip{{-0.1, 0.3, 0.2}, {-0.7, 0.5, -2}};
  const Model lumped =
      model(frame + arm + tip +
            joint("a", "fixed", "frame", "arm", "xyz=\"0.2 0.1 -0.1\" rpy=\"0.3 -0.2 1.5\"") +
            joint("b", "fixed", "arm", "tip", "xyz=\"-0.1 0.3 0.2\" rpy=\"-0.7 0.5 -2\""));

  REQUIRE(lumped.links.size() == 1);
  CHECK(lumped.links[0].name == "frame");
  for (const char* name : {"frame", "arm", "tip"}) CHECK(lumped.body_of_link.at(name) == 0);
  CHECK(lumped.links[0].inertial.pose.rpy == Vector3d::Zero());
  check_same(mass_properties(lumped),
             sum_of(points_of(inertial_of(frame), {}) + points_of(inertial_of(arm), frame_arm) +
                    points_of(inertial_of(tip), frame_arm * arm_tip)));
}

TEST_CASE("the whole vehicle has the inertia of its points, rotors included") {
  const Model hexa = hexarotor();
  const std::vector<Eigen::Isometry3d> poses = link_poses(hexa);
  std::vector<PointMass> points;
  for (std::size_t i = 0; i < hexa.links.size(); ++i) {
    const Pose pose{poses[i].translation(), rpy_from_quaternion(Quaterniond(poses[i].linear()))};
    points = points + points_of(hexa.links[i].inertial, pose);
  }
  check_same(mass_properties(hexa), sum_of(points));
  CHECK(mass_properties(hexa).mass == doctest::Approx(1.4 + 6 * 0.08 + 6 * 0.012));
}

TEST_CASE("the hexarotor's frame has the ten numbers that Gazebo printed") {
  const Model printed = converted_to_sdf(hexarotor());
  const Inertial& frame = printed.links[0].inertial;
  CHECK(frame.mass == 1.88);
  CHECK(frame.pose.xyz == Vector3d(0.007447, -0.003723, 0.016681));
  CHECK(frame.inertia(0, 0) == 0.0225097);
  CHECK(frame.inertia(0, 1) == 0.000445692);
  CHECK(frame.inertia(0, 2) == -0.000346468);
  CHECK(frame.inertia(1, 1) == 0.0239903);
  CHECK(frame.inertia(1, 2) == 0.000223234);
  CHECK(frame.inertia(2, 2) == 0.0431612);
}

TEST_CASE("the axis is rounded as it is written and only then made a unit vector") {
  const auto axis = [](const std::string& engine, const std::string& written) -> Vector3d {
    std::string turn = joint("turn", "continuous", "frame", "rotor");
    turn.replace(turn.find("0 0 1"), 5, written);
    const Model m = model(link("frame", 1, round_body) + link("rotor", 0.1, round_body) + turn);
    return make_engine(engine, m, World{})->model().joints[0].axis;
  };
  const Vector3d exact = Vector3d(0, 0.1, 1).normalized();
  CHECK(axis("gazebo11", "0 0.1 1") == exact);
  CHECK(axis("gazebo11", "0 0.10000004 0.99999996") == exact);
  CHECK(axis("gazebo11", "0 0.0995037 0.995037") == Vector3d(0, 0.099504, 0.995037).normalized());
  CHECK((axis("gazebo11", "0 0.099504 0.995037") - exact).norm() > 1e-7);
  CHECK(axis("ode", "0 0.1 1") == exact);
  CHECK(axis("ode", "0 0.10000004 0.99999996") != exact);
  const std::string message = refusal([&] { axis("gazebo11", "0 0 4e-7"); });
  CHECK(message.rfind("test.urdf:4: joint 'turn': after rounding to 6 decimals, as in Gazebo,",
                      0) == 0);
  CHECK(axis("ode", "0 0 4e-7") == Vector3d::UnitZ());
}

TEST_CASE("an inertia that Gazebo's rounding spoils is refused by the engine that rounds it") {
  // Principal moments 1e-10, 0.01, 0.01, turned by 0.6 rad about z.
  const Model m = model(link("frame", 1.2,
                             "ixx=\"0.0031882112957345205\" ixy=\"-0.0046601953832341786\" "
                             "ixz=\"0\" iyy=\"0.006811788804265481\" iyz=\"0\" izz=\"0.01\""));
  const std::string message = refusal([&] { make_engine("gazebo11", m, World{}); });
  CHECK(message.rfind("test.urdf:2: link 'frame': after rounding to 6 digits, as in Gazebo,", 0) ==
        0);
  CHECK(contains(message, "use the engine ode"));
  make_engine("ode", m, World{});
  make_engine("eigen", m, World{});
}

TEST_CASE("a robot without links is refused") {
  CHECK(contains(refusal([] { model(""); }), "test.urdf:1: <robot> has no <link>"));
}

TEST_CASE("a massless link on a fixed joint is carried along") {
  const Model m = model(link("frame", 1, round_body) + "<link name=\"mast\"/>\n" +
                        link("rotor", 0.1, round_rotor) +
                        joint("weld", "fixed", "frame", "mast", "xyz=\"1 2 3\"") +
                        joint("turn", "continuous", "mast", "rotor", "xyz=\"0.1 0 0\""));
  REQUIRE(m.links.size() == 2);
  CHECK(m.links[0].inertial.mass == 1);
  CHECK(m.joints[0].parent == 0);
  CHECK((m.joints[0].pose.xyz - Vector3d(1.1, 2, 3)).norm() < 1e-15);
  CHECK(m.body_of_link.at("mast") == 0);
}

TEST_CASE("a root without inertia takes that of the link fixed to it, and keeps its name") {
  const Model m = model("<link name=\"base\"/>\n" + link("frame", 1, round_body) +
                        joint("weld", "fixed", "base", "frame", "xyz=\"0 0 0.5\""));
  REQUIRE(m.links.size() == 1);
  CHECK(m.links[0].name == "base");
  CHECK(m.links[0].inertial.mass == 1);
  CHECK(m.links[0].inertial.pose.xyz == Vector3d(0, 0, 0.5));
  CHECK(m.body_of_link.at("base") == 0);
  CHECK(m.body_of_link.at("frame") == 0);
}

TEST_CASE("links fixed to a rotor turn with it") {
  const Model m =
      model(link("frame", 1, round_body) + link("rotor", 0.1, round_rotor) +
            link("cap", 0.1, round_rotor) + joint("turn", "continuous", "frame", "rotor") +
            joint("weld", "fixed", "rotor", "cap", "xyz=\"0 0 0.2\""));
  REQUIRE(m.links.size() == 2);
  CHECK(m.body_of_link.at("cap") == 1);
  CHECK(m.links[1].inertial.mass == doctest::Approx(0.2));
  CHECK((m.links[1].inertial.pose.xyz - Vector3d(0, 0, 0.1)).norm() < 1e-15);
}

TEST_CASE("joints keep the order of the file, parents before their children") {
  const Model m = model(
      link("frame", 1, round_body) + link("a", 0.1, round_rotor) + link("b", 0.1, round_rotor) +
      link("c", 0.1, round_rotor) + joint("late", "continuous", "b", "c") +
      joint("first", "continuous", "frame", "a") + joint("second", "continuous", "frame", "b"));
  CHECK(m.joint_names() == std::vector<std::string>{"first", "second", "late"});
  for (std::size_t i = 0; i < m.joints.size(); ++i) CHECK(m.joints[i].parent <= i);
  CHECK(m.links[3].name == "c");
}

TEST_CASE("Gazebo's order is depth first, joints by name, through links that are lumped") {
  const auto rotor = [](const std::string& name, const std::string& parent) {
    return link(name, 0.1, round_rotor) + joint("turns_" + name, "continuous", parent, name);
  };
  const Model m =
      model(link("frame", 1, round_body) + link("z_arm", 0.1, round_body) +
            link("a_arm", 0.1, round_body) + rotor("d", "frame") + rotor("c", "z_arm") +
            rotor("b", "a_arm") + rotor("a", "frame") + rotor("aa", "d") +
            joint("z", "fixed", "frame", "z_arm") + joint("b", "fixed", "frame", "a_arm"));
  std::vector<std::string> names;
  for (const std::size_t i : sdf_order(m)) names.push_back(m.links[i].name);
  CHECK(names == std::vector<std::string>{"frame", "b", "a", "d", "aa", "c"});
}

TEST_CASE("collision shapes move with the links that are lumped") {
  const Model m = model(
      link("frame", 1, round_body) +
      "<link name=\"foot\"><collision><origin xyz=\"0 0 -0.1\"/><geometry><sphere "
      "radius=\"0.02\"/></geometry></collision></link>\n" +
      joint("weld", "fixed", "frame", "foot", "xyz=\"1 0 0\" rpy=\"1.5707963267948966 0 0\""));
  REQUIRE(m.links[0].collisions.size() == 1);
  const Collision& foot = m.links[0].collisions[0];
  CHECK(foot.kind == ShapeKind::sphere);
  CHECK(foot.size.x() == 0.02);
  CHECK((foot.pose.xyz - Vector3d(1, 0.1, 0)).norm() < 1e-15);
}
