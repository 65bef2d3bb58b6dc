#include <cmath>

#include "flat_table.hpp"
#include "modelled_vehicles.hpp"
#include "numbers.hpp"
#include "quadcore/control/flat_state.hpp"

using namespace quadcore;
using namespace quadcore::control;

namespace {

/// Position, velocity, orientation and rate of a body that is turned and pushed from outside.
struct Body {
  Vector3d p, v;
  Matrix3d R;
  Vector3d w;
};

Body operator+(const Body& a, const Body& b) {
  return {a.p + b.p, a.v + b.v, a.R + b.R, a.w + b.w};
}
Body operator*(double s, const Body& a) { return {s * a.p, s * a.v, s * a.R, s * a.w}; }

}  // namespace

TEST_CASE("a body that is turned and lifted as the flat state says flies the reference") {
  ModelledVehicle model = test::odd_belief(4);
  model.p_FCcm_F.setZero();
  model.air.linear.diagonal() << 0.07, 0.07, 0.01, 0, 0, 0;
  model.air.quadratic = 0.02;
  model.air.of_components = {0, 0, 0.012};
  for (const char* name : {"eight", "circle", "spiral"}) {
    CAPTURE(name);
    for (const bool with_drag : {false, true}) {
      const auto shape = make_reference(name, {{"rate", 1.9}, {"yaw_rate", 0.7}, {"yaw", 2}});
      // Newton's law with the air's force written out here, not taken from the model.
      const auto derivative = [&](const Body& b, double t) {
        const FlatState flat = flat_state(shape->at(t), model, with_drag);
        Vector3d f_W = flat.thrust * b.R.col(2) + Vector3d(0, 0, -model.mass * model.gravity);
        if (with_drag) {
          const Vector3d v_F = b.R.transpose() * b.v;
          f_W -= b.R * Vector3d(0.07 * v_F.x(), 0.07 * v_F.y(), 0.01 * v_F.z());
          f_W -= 0.02 * b.v.norm() * b.v;
          f_W -= 0.012 * std::abs(b.v.z()) * b.v.z() * b.R.col(2);
        }
        return Body{b.v, f_W / model.mass, b.R * skew(b.w), flat.dw_WF_F};
      };
      const FlatState flat = flat_state(shape->at(0), model, with_drag);
      Body body{shape->at(0).position, shape->at(0).velocity, flat.R_WF, flat.w_WF_F};
      constexpr double h = 1e-3;
      for (int step = 0; step < 2000; ++step) {
        const double t = h * step;
        const Body k1 = derivative(body, t), k2 = derivative(body + h / 2 * k1, t + h / 2),
                   k3 = derivative(body + h / 2 * k2, t + h / 2),
                   k4 = derivative(body + h * k3, t + h);
        body = body + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
      }
      const Reference wanted = shape->at(2);
      CHECK((body.p - wanted.position).norm() < 1e-8);
      CHECK((body.v - wanted.velocity).norm() < 1e-8);
      const FlatState then = flat_state(wanted, model, with_drag);
      CHECK((body.R - then.R_WF).norm() < 1e-8);
      CHECK((body.w - then.w_WF_F).norm() < 1e-8);
    }
  }
}

TEST_CASE(
    "a vehicle with its mass off the origin of its frame flies the reference with the origin") {
  ModelledVehicle model = test::odd_belief(4);
  model.p_FCcm_F = {0.05, -0.02, 0.01};
  model.air.linear.diagonal() << 0.07, 0.07, 0.01, 0, 0, 0;
  struct Way {
    const char* name;
    Values values;
    double bar;
  };
  // A steady turn is exact; elsewhere the derivatives that a reference does not have are missing.
  for (const Way& way : {Way{"hover", {{"yaw_rate", 2}}, 1e-4}, Way{"circle", {{"along", 1}}, 1e-4},
                         Way{"circle", {{"rate", 1.2}}, 0.01}, Way{"eight", {}, 0.01}}) {
    CAPTURE(way.name);
    const auto shape = make_reference(way.name, way.values);
    for (const double t : {0.1, 0.7, 1.6, 2.3}) {
      // The forces on the centre of mass, which differences of its place tell.
      const auto centre = [&](double at) -> Vector3d {
        return shape->at(at).position +
               flat_state(shape->at(at), model, true).R_WF * model.p_FCcm_F;
      };
      constexpr double h = 1e-3;
      const Vector3d a_W = (centre(t + h) - 2 * centre(t) + centre(t - h)) / (h * h);
      const Vector3d v_W = (centre(t + h) - centre(t - h)) / (2 * h);
      const FlatState flat = flat_state(shape->at(t), model, true);
      const Vector3d v_F = flat.R_WF.transpose() * v_W;
      const Vector3d air_W =
          -(flat.R_WF * Vector3d(0.07 * v_F.x(), 0.07 * v_F.y(), 0.01 * v_F.z()));
      const Vector3d rotors_W = flat.thrust * flat.R_WF.col(2);
      const Vector3d rest_W = model.mass * (a_W + Vector3d(0, 0, model.gravity)) - air_W - rotors_W;
      CHECK(rest_W.norm() < way.bar * model.mass);
    }
  }
}

TEST_CASE("the yaw of the flat state is that of roll, pitch and yaw") {
  const ModelledVehicle model = test::odd_belief(4);
  const auto shape = make_reference("eight", {{"yaw", 1.1}, {"yaw_rate", 0.5}});
  for (const double t : {0.0, 0.4, 1.3}) {
    const FlatState flat = flat_state(shape->at(t), model, false);
    CHECK(rpy_from_quaternion(Quaterniond(flat.R_WF)).z() ==
          doctest::Approx(1.1 + 0.5 * t).epsilon(1e-12));
  }
}

TEST_CASE("a reference that falls freely has no attitude") {
  Reference falling;
  falling.acceleration.z() = -9.7;
  CHECK_THROWS_WITH(flat_state(falling, test::odd_belief(4), false),
                    "the reference has no defined attitude: it is in free fall, or its thrust "
                    "points along its own x axis.");
}

TEST_CASE("flat states of several references are bit-identical to those of each alone") {
  ModelledVehicle model = test::odd_belief(4);
  model.air.linear.diagonal() << 0.07, 0.05, 0.01, 0, 0, 0;
  model.air.quadratic = 0.02;
  model.air.of_components = {0, 0, 0.012};
  for (const bool is_offset : {true, false}) {
    if (!is_offset) model.p_FCcm_F.setZero();
    for (const bool with_drag : {false, true}) {
      FlatTable table(model, with_drag);
      const auto eight = make_reference("eight", {{"along", 1}, {"yaw_rate", 0.3}});
      const auto hover = make_reference("hover", {{"yaw", 1}});  // where drag has a kink
      const auto wanted = [&](std::size_t i) {
        return i == 3 ? hover->at(0) : eight->at(0.37 * static_cast<double>(i));
      };
      for (std::size_t i = 0; i < widest_lanes; ++i) {
        table.set(i, wanted(i), elementary::sincos(wanted(i).yaw));
      }
      table.solve(widest_lanes);
      for (std::size_t i = 0; i < widest_lanes; ++i) {
        CAPTURE(i);
        REQUIRE(table.is_defined(i));
        const FlatState one = table.state(i), alone = flat_state(wanted(i), model, with_drag);
        CHECK(one.R_WF == alone.R_WF);
        CHECK(one.w_WF_F == alone.w_WF_F);
        CHECK(one.dw_WF_F == alone.dw_WF_F);
        CHECK(one.a_FCcm_W == alone.a_FCcm_W);
        CHECK(one.thrust == alone.thrust);
        CHECK(one.across_W == across_yaw(wanted(i).yaw));
        CHECK(list_numbers(table.numbers(wanted(i), i)) ==
              list_numbers(numbers_of(wanted(i), &alone)));
      }
    }
  }
}

TEST_CASE("a reference without a defined attitude has no flat state next to others") {
  FlatTable table(test::odd_belief(4), false);
  Reference falling;
  falling.acceleration.z() = -test::odd_belief(4).gravity;
  table.set(0, falling, {0, 1});
  table.set(1, Reference(), {0, 1});
  table.solve(2);
  CHECK_FALSE(table.is_defined(0));
  CHECK(table.is_defined(1));
}
