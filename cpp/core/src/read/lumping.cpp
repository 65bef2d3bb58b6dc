#include "lumping.hpp"

#include <set>

#include "quadcore/plugin/error.hpp"
#include "quadcore/text.hpp"
#include "references.hpp"

namespace quadcore {
namespace {

/// Return the sum of two bodies' inertias. Both poses and the result refer to the same frame.
Inertial combined(const Inertial& a, const Inertial& b) {
  Inertial sum;
  sum.mass = a.mass + b.mass;
  if (sum.mass > 0) sum.pose.xyz = (a.mass * a.pose.xyz + b.mass * b.pose.xyz) / sum.mass;
  for (const Inertial* part : {&a, &b}) {
    const Matrix3d S = skew(part->pose.xyz - sum.pose.xyz);
    sum.inertia += part->inertia_in_link_axes() - part->mass * S * S;  // parallel axes
  }
  return sum;
}

void check_body(const Link& link, bool has_inertial) {
  const std::string who = link.where + ": link '" + link.name + "' moves but has ";
  if (!has_inertial) {
    throw InputError(who + "no <inertial>. Add one, or fix the link to another link.");
  }
  if (!(link.inertial.mass > 0)) {
    throw InputError(who + "no mass. Write <mass value=\"...\"/> in kg, > 0.");
  }
  if (!link.inertial.is_positive()) {
    const Vector3d principal = link.inertial.principal_moments();
    std::string moments;
    for (int i = 0; i < 3; ++i) {
      moments += moments.empty() ? "" : ", ";
      append_shortest(with_digits(principal[i], 4), moments);
    }
    throw InputError(
        who + "the principal moments of inertia " + moments +
        " kg m^2. All of them must be positive and of comparable size. Correct the <inertia>.");
  }
}

/// Every engine except gazebo11 merges a link behind a locked joint with its parent.
void check_locked(const UrdfJoint& joint, const UrdfLink& link, const Link& body) {
  if (link.tags.gravity == body.tags.gravity &&
      link.tags.damping_factor == body.tags.damping_factor) {
    return;
  }
  throw InputError((link.tags.where.empty() ? body.tags.where : link.tags.where) +
                   ": the locked joint '" + joint.name + "' merges link '" + link.name +
                   "' with '" + body.name +
                   "', which has different gravity or damping. Give both links the same "
                   "<turnGravityOff> and <dampingFactor>.");
}

/// The body that a link is part of and the pose of the link in it.
struct Carried {
  std::size_t body;
  Pose pose;
};

}  // namespace

Model lump(const UrdfTree& tree) {
  std::map<std::string, const UrdfLink*> links;
  for (const UrdfLink& link : tree.links) links[link.name] = &link;
  Model model;
  model.name = tree.name;
  model.plugins = tree.plugins;
  model.warnings = tree.warnings;
  model.ignored_elements = tree.ignored_elements;

  std::map<std::string, Carried> carried;
  std::vector<bool> has_inertial;
  const auto add_to_body = [&](const UrdfLink& link, const Carried& place) {
    Link& body = model.links[place.body];
    // The body's own link keeps its numbers as written; sums use the body's axes.
    const bool own = body.name == link.name;
    if (link.inertial) {
      Inertial in_body = *link.inertial;
      in_body.pose = place.pose * in_body.pose;
      if (own) {
        body.inertial = *link.inertial;
      } else {
        body.inertial = combined(body.inertial, in_body);
      }
      has_inertial[place.body] = true;
    }
    for (Collision collision : link.collisions) {
      if (!own) collision.pose = place.pose * collision.pose;
      body.collisions.push_back(collision);
    }
    carried[link.name] = place;
    model.body_of_link[link.name] = place.body;
    model.pose_of_link[link.name] = place.pose;
  };
  const auto add_body = [&](const UrdfLink& link) {
    model.links.push_back({link.name, {}, {}, link.where, link.tags});
    has_inertial.push_back(false);
    add_to_body(link, {model.links.size() - 1, Pose{}});
  };

  add_body(*links.at(tree.root));
  // Joints are processed in file order, but parents always come before their children.
  std::map<std::string, std::vector<std::size_t>> below;
  for (std::size_t i = 0; i < tree.joints.size(); ++i) {
    below[tree.joints[i].parent].push_back(i);
  }
  const std::vector<std::size_t>& first = below[tree.root];
  std::set<std::size_t> ready(first.begin(), first.end());
  while (!ready.empty()) {
    const UrdfJoint& joint = tree.joints[*ready.begin()];
    ready.erase(ready.begin());
    const std::vector<std::size_t>& next = below[joint.child];
    ready.insert(next.begin(), next.end());
    const Carried& parent = carried.at(joint.parent);
    const Pose pose = parent.pose * joint.pose;
    if (joint.fixed) {
      if (joint.locked) check_locked(joint, *links.at(joint.child), model.links[parent.body]);
      add_to_body(*links.at(joint.child), {parent.body, pose});
    } else {
      model.joints.push_back({joint.name, parent.body,
                              joint.parent == model.links[parent.body].name ? joint.pose : pose,
                              joint.axis.normalized(), joint.damping, joint.friction,
                              joint.implicit_damping, joint.where});
      add_body(*links.at(joint.child));
    }
  }
  for (std::size_t i = 0; i < model.links.size(); ++i) check_body(model.links[i], has_inertial[i]);
  return model;
}

Model read_model(const Document& document, const std::vector<std::string>& ignore) {
  const auto tree = std::make_shared<UrdfTree>(read_urdf_tree(document, ignore));
  check_topology(*tree);
  apply_references(*tree);
  Model model = lump(*tree);
  model.urdf = tree;
  model.source = std::make_shared<Source>(Source{document, ignore});
  return model;
}

}  // namespace quadcore
