#include "quadcore/fingerprint.hpp"

#include <algorithm>
#include <utility>

#include "quadcore/plugin/error.hpp"
#include "quadcore/simulation.hpp"
#include "quadcore/text.hpp"

namespace quadcore {
namespace {

using Numbers = std::vector<double>;

void add(Facts& facts, std::string what, Numbers numbers) {
  facts.push_back({std::move(what), std::move(numbers), ""});
}

Numbers numbers(const Vector3d& v) { return {v.data(), v.data() + 3}; }

Numbers numbers(const Matrix3d& m) { return {m.data(), m.data() + 9}; }

Numbers numbers(const Pose& pose) {
  const Vector3d &p = pose.xyz, &r = pose.rpy;
  return {p[0], p[1], p[2], r[0], r[1], r[2]};
}

void add_surface(Facts& facts, const std::string& who, const Surface& s) {
  add(facts, who + " mu1, mu2", {s.mu1, s.mu2});
  add(facts, who + " fdir1", numbers(s.fdir1));
  add(facts, who + " kp, kd", {s.kp, s.kd});
  add(facts, who + " minDepth, maxVel, maxContacts",
      {s.min_depth, s.max_vel, static_cast<double>(s.max_contacts)});
}

void add_shape(Facts& facts, const std::string& who, const Collision& shape) {
  add(facts, who + " kind of shape", {static_cast<double>(shape.kind)});
  add(facts, who + " size", numbers(shape.size));
  add(facts, who + " place of the shape", numbers(shape.pose));
  add_surface(facts, who, shape.surface);
}

Facts facts_of(const Model& model) {
  Facts facts = {{"name", {}, model.name}};
  for (const Link& link : model.links) {
    const std::string who = "link " + link.name;
    add(facts, who + " mass", {link.inertial.mass});
    add(facts, who + " inertia", numbers(link.inertial.inertia));
    add(facts, who + " centre of mass", numbers(link.inertial.pose));
    add(facts, who + " gravity", {link.tags.gravity ? 1.0 : 0.0});
    add(facts, who + " damping factor", {link.tags.damping_factor});
    for (const Collision& shape : link.collisions) add_shape(facts, who, shape);
  }
  for (const Joint& joint : model.joints) {
    const std::string who = "joint " + joint.name;
    add(facts, who + " parent", {static_cast<double>(joint.parent)});
    add(facts, who + " origin", numbers(joint.pose));
    add(facts, who + " axis", numbers(joint.axis));
    add(facts, who + " damping", {joint.damping});
    add(facts, who + " implicit damping", {joint.implicit_damping ? 1.0 : 0.0});
    add(facts, who + " friction", {joint.friction});
  }
  for (const auto& [link, body] : model.body_of_link) {
    add(facts, "link " + link + " body", {static_cast<double>(body)});
    add(facts, "link " + link + " place in its body", numbers(model.pose_of_link.at(link)));
  }
  return facts;
}

void add_obstacle(Facts& facts, const Obstacle& obstacle) {
  const std::string who = "obstacle " + obstacle.model + "::" + obstacle.name;
  add(facts, who + " kind", {static_cast<double>(obstacle.kind)});
  add(facts, who + " size", numbers(obstacle.size));
  add(facts, who + " position", numbers(obstacle.position_W));
  add(facts, who + " orientation", numbers(obstacle.orientation_W.toRotationMatrix()));
  add_surface(facts, who, obstacle.surface);
  add(facts, who + " slip1, slip2", {obstacle.slip1, obstacle.slip2});
  add(facts, who + " restitution", {obstacle.restitution, obstacle.restitution_speed});
}

void add_free_body(Facts& facts, const FreeBody& body) {
  const std::string who = "free body " + body.model + "::" + body.name;
  add(facts, who + " mass", {body.inertial.mass});
  add(facts, who + " centre of mass", numbers(body.inertial.pose.xyz));
  add(facts, who + " inertia", numbers(body.inertial.inertia_in_link_axes()));
  add(facts, who + " position", numbers(body.position_W));
  add(facts, who + " orientation", numbers(body.orientation_W.toRotationMatrix()));
  add(facts, who + " velocity", numbers(body.linear_velocity_W));
  add(facts, who + " angular velocity", numbers(body.angular_velocity_W));
  add(facts, who + " settings",
      {body.gravity ? 1.0 : 0.0, body.may_sleep ? 1.0 : 0.0, body.collides_own ? 1.0 : 0.0,
       body.linear_decay, body.angular_decay});
  for (const Obstacle& shape : body.shapes) add_obstacle(facts, shape);
}

void add_free_joint(Facts& facts, const FreeJoint& joint) {
  const std::string who = "free joint " + joint.name;
  add(facts, who + " kind", {static_cast<double>(joint.kind)});
  add(facts, who + " links", {static_cast<double>(joint.child), static_cast<double>(joint.parent)});
  add(facts, who + " anchors", numbers(joint.anchor_C));
  add(facts, who + " anchor in the parent", numbers(joint.anchor_P));
  add(facts, who + " axis", numbers(joint.axis_C));
  add(facts, who + " axis in the parent", numbers(joint.axis_P));
  add(facts, who + " zero", numbers(joint.q_PC_at_zero.toRotationMatrix()));
  add(facts, who + " limits", {joint.lower, joint.upper});
  add(facts, who + " loads", {joint.damping, joint.friction, joint.stiffness, joint.rest_position});
}

Facts facts_of(const World& world) {
  Facts facts;
  add(facts, "max_step_size", {world.max_step_size});
  add(facts, "gravity", numbers(world.gravity_W));
  add(facts, "wind", numbers(world.wind_W));
  const Atmosphere& air = world.atmosphere;
  add(facts, "atmosphere", {air.temperature, air.temperature_gradient, air.pressure});
  add(facts, "magnetic field", numbers(world.magnetic_field_W));
  add(facts, "ground plane", {world.ground_plane ? 1.0 : 0.0});
  if (world.ground_plane) add_surface(facts, "ground plane", world.ground);
  add(facts, "max_contacts", {static_cast<double>(world.max_contacts)});
  for (const Obstacle& obstacle : world.obstacles) add_obstacle(facts, obstacle);
  for (const FreeBody& body : world.free_bodies) add_free_body(facts, body);
  for (const FreeJoint& joint : world.free_joints) add_free_joint(facts, joint);
  facts.push_back({"solver", {}, world.solver_type});
  add(facts, "iters", {static_cast<double>(world.solver_iterations)});
  add(facts, "sor", {world.solver_sor});
  add(facts, "erp", {world.erp});
  add(facts, "cfm", {world.cfm});
  add(facts, "contact_max_correcting_vel", {world.contact_max_correcting_vel});
  return facts;
}

Facts facts_of(const std::vector<LoadedPlugin>& plugins, const Topics& topics) {
  Facts facts;
  for (const LoadedPlugin& p : plugins) {
    facts.push_back({"plugin " + p.name, {static_cast<double>(p.state_size)}, p.filename});
  }
  for (const std::string& name : topics.names()) {
    const MessageKind& kind = topics[topics.at(name)].kind;
    facts.push_back({"topic " + name, {}, kind.name + ": " + joined(kind.fields)});
  }
  return facts;
}

Facts parameters_of(const std::vector<LoadedPlugin>& plugins) {
  Facts facts;
  for (const LoadedPlugin& p : plugins) {
    for (const Parameter& parameter : p.parameters.all()) {
      facts.push_back({p.name + "." + parameter.spec.name, parameter.numbers,
                       parameter.numbers.empty() ? parameter.text : ""});
    }
  }
  return facts;
}

/// Format the i-th fact for a message.
std::string format_fact(const Facts& facts, std::size_t i) {
  if (i >= facts.size()) return "nothing";
  std::string text = facts[i].what;
  for (const double number : facts[i].numbers) {
    text += ' ';
    append_shortest(number, text);
  }
  return "'" + trimmed(text + " " + facts[i].text) + "'";
}

std::string first_difference(const Facts& there, const Facts& here) {
  std::size_t i = 0;
  while (i < there.size() && i < here.size() && there[i] == here[i]) ++i;
  return format_fact(there, i) + " there, " + format_fact(here, i) + " here";
}

}  // namespace

const std::vector<FingerprintPart>& fingerprint_parts() {
  static const std::vector<FingerprintPart> parts = {
      {"engine", "engine", &Fingerprint::engine, nullptr},
      {"step", "step", &Fingerprint::step, nullptr},
      {"model", "model", &Fingerprint::model, nullptr},
      {"plugins", "set of plugins", &Fingerprint::plugins, nullptr},
      {"world", "world", &Fingerprint::world, &Allowed::world},
      {"parameters", "set of parameters", &Fingerprint::parameters, &Allowed::parameters},
  };
  return parts;
}

Fingerprint::Fingerprint(const std::string& engine_name, double dt, const Model& flown,
                         const World& around, const std::vector<LoadedPlugin>& loaded,
                         const Topics& topics)
    : engine{{"", {}, engine_name}},
      step{{"", {dt}, ""}},
      model(facts_of(flown)),
      plugins(facts_of(loaded, topics)),
      world(facts_of(around)),
      parameters(parameters_of(loaded)) {}

Allowed Allowed::of(const std::vector<std::string>& names) {
  Allowed allowed;
  std::vector<std::string> known;
  for (const FingerprintPart& part : fingerprint_parts()) {
    if (!part.allowed) continue;
    known.push_back(part.name);
    allowed.*part.allowed = std::find(names.begin(), names.end(), part.name) != names.end();
  }
  for (const std::string& name : names) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    throw InputError("allow '" + name +
                     "': this part may not differ. Choose from: " + joined(known) + ".");
  }
  return allowed;
}

void check_same(const Fingerprint& there, const Fingerprint& here, const Allowed& allowed) {
  std::string differences;
  std::vector<std::string> to_allow;
  bool fatal = false;
  for (const FingerprintPart& part : fingerprint_parts()) {
    if (there.*part.facts == here.*part.facts) continue;
    if (part.allowed && allowed.*part.allowed) continue;
    differences += (differences.empty() ? "" : ", ") + std::string("a different ") + part.what +
                   " (" + first_difference(there.*part.facts, here.*part.facts) + ")";
    if (part.allowed) to_allow.push_back(part.name);
    fatal = fatal || !part.allowed;
  }
  if (differences.empty()) return;
  throw InputError("snapshot: it was taken with " + differences +
                   ". Restore a snapshot of this simulation" +
                   (fatal ? "" : ", or allow " + joined(to_allow) + " to differ") + ".");
}

}  // namespace quadcore
