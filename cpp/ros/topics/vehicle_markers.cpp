#include "vehicle_markers.hpp"

#include <visualization_msgs/MarkerArray.h>

#include <cmath>

#include "messages.hpp"
#include "plant.hpp"
#include "quadcore/control/start.hpp"
#include "quadcore/drawing.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/text.hpp"

namespace quadcore::node {
namespace {

using visualization_msgs::Marker;

struct Colour {
  float r, g, b;
};
constexpr Colour ahead = {0.0f, 0.45f, 0.70f}, back = {0.84f, 0.37f, 0.0f};
constexpr Colour still = {0.6f, 0.6f, 0.6f}, dark = {0.15f, 0.15f, 0.15f};

/// Returns the rates of the joints in a hover [rad/s]; zeros if no plugin drives them or if they
/// cannot hover.
VectorXd find_hover_rates(Simulation& simulation) {
  try {
    return control::start_on({}, simulation.describe_vehicle()).rotor_velocity;
  } catch (const InputError&) {
    return VectorXd::Zero(static_cast<Eigen::Index>(simulation.model().joints.size()));
  }
}

/// Returns the colour of a rotor's sense of rotation, seen from above.
Colour choose_colour(double turn) { return turn > 0 ? ahead : turn < 0 ? back : still; }

Marker make_marker(const std::string& frame, const std::string& group, std::size_t id, int type,
                   const Vector3d& place, const Vector3d& scale, const Colour& colour,
                   float alpha) {
  Marker made;
  made.header.frame_id = frame;
  made.frame_locked = true;  // moves with its frame
  made.ns = group;
  made.id = static_cast<int>(id);
  made.type = type;
  set_vector(made.pose.position, place.data());
  made.pose.orientation.w = 1;
  set_vector(made.scale, scale.data());
  made.color.r = colour.r;
  made.color.g = colour.g;
  made.color.b = colour.b;
  made.color.a = alpha;
  return made;
}

Marker make_text(const std::string& frame, const std::string& group, std::size_t id,
                 const std::string& words, const Vector3d& place, double height,
                 const Colour& colour) {
  Marker made =
      make_marker(frame, group, id, Marker::TEXT_VIEW_FACING, place, {0, 0, height}, colour, 1);
  made.text = words;
  return made;
}

/// Adds a line along an arc that begins at x, then the two sides of a tip.
void add_arrow(Marker& line, double radius, double sense) {
  constexpr int parts = 30;
  const double arc = 1.5 * M_PI;
  const auto at = [&](double angle, double r) {
    geometry_msgs::Point point;
    point.x = r * std::cos(sense * angle);
    point.y = r * std::sin(sense * angle);
    return point;
  };
  const auto add = [&](const geometry_msgs::Point& a, const geometry_msgs::Point& b) {
    line.points.push_back(a);
    line.points.push_back(b);
  };
  for (int i = 0; i < parts; ++i)
    add(at(arc * i / parts, radius), at(arc * (i + 1) / parts, radius));
  for (const double side : {0.8, 1.2}) add(at(arc, radius), at(arc - 0.35, side * radius));
}

}  // namespace

VehicleMarkers::VehicleMarkers(ros::NodeHandle& nh, Simulation& simulation, const Frames& frames)
    : publisher_(nh.advertise<visualization_msgs::MarkerArray>("vehicle_markers", 1, true)) {
  const Model& model = simulation.model();
  const double radius = drawn_disc_radius(model);
  const VectorXd rates = find_hover_rates(simulation);
  const std::vector<Eigen::Isometry3d> poses = link_poses(model);
  const std::string root = frames.of_link(model.links.front().name);
  visualization_msgs::MarkerArray all;
  const auto add = [&all](const Marker& made) { all.markers.push_back(made); };

  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const Link& link = model.links[i];
    const std::string frame = frames.of_link(link.name);
    const InertiaBox box = inertia_box(link.inertial);
    Vector3d axis = Vector3d::UnitZ();
    if (i > 0) axis = poses[i].linear() * model.joints[i - 1].axis;
    const double rate = i == 0 ? 0 : rates[static_cast<Eigen::Index>(i - 1)];
    const Colour colour = i == 0 ? dark : choose_colour(rate * axis.z());
    // A flat box gets a small thickness, because rviz warns about zero.
    const Vector3d edges = box.edges.cwiseMax(1e-4);
    Marker cube = make_marker(frame, "boxes", i, Marker::CUBE, box.center, edges, colour, 0.35f);
    set_quaternion(cube.pose.orientation, box.orientation.coeffs().data());
    add(cube);
    std::string mass;
    append_shortest(with_digits(link.inertial.mass, 4), mass);
    add(make_text(frame, "masses", i, mass + " kg", box.center - 0.3 * radius * Vector3d::UnitZ(),
                  0.25 * radius, dark));
    if (i == 0) continue;
    // In the root's axes, because these do not spin.
    const Vector3d place = poses[i].translation();
    const Quaterniond along = Quaterniond::FromTwoVectors(Vector3d::UnitZ(), axis);
    Marker disc = make_marker(root, "discs", i, Marker::CYLINDER, place,
                              {2 * radius, 2 * radius, 0.01 * radius}, colour, 0.25f);
    set_quaternion(disc.pose.orientation, along.coeffs().data());
    add(disc);
    add(make_text(root, "numbers", i, std::to_string(i), place + 0.35 * radius * axis, 0.5 * radius,
                  colour));
    if (rate == 0) continue;
    Marker spin = make_marker(root, "spins", i, Marker::LINE_LIST, place + 0.05 * radius * axis,
                              {0.06 * radius, 0, 0}, colour, 1);
    set_quaternion(spin.pose.orientation, along.coeffs().data());
    add_arrow(spin, 0.75 * radius, rate > 0 ? 1 : -1);
    add(spin);
  }
  add(make_marker(root, "centre_of_mass", 0, Marker::SPHERE, mass_properties(model).p_FCcm,
                  Vector3d::Constant(0.12 * radius), dark, 1));
  publisher_.publish(all);
}

}  // namespace quadcore::node
