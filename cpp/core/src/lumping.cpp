#include <set>

#include "quadcore/error.hpp"
#include "quadcore/text.hpp"
#include "urdf_tree.hpp"

namespace quadcore {
namespace {

/// Indices into the tree: the joint above each link, and the links by name.
struct Topology {
  std::map<std::string, std::size_t> links;
  std::map<std::string, const UrdfJoint*> joint_above;
  std::string root;
};

template <typename Named>
std::map<std::string, std::size_t> index_by_name(const std::vector<Named>& items,
                                                 const std::string& kind) {
  std::map<std::string, std::size_t> index;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const auto [first, added] = index.emplace(items[i].name, i);
    if (!added) {
      throw InputError(items[i].where + ": a second " + kind + " named '" + items[i].name +
                       "' (first at " + items[first->second].where + "); give it another name");
    }
  }
  return index;
}

Topology check_topology(const UrdfTree& tree) {
  Topology topology;
  topology.links = index_by_name(tree.links, "link");
  index_by_name(tree.joints, "joint");
  if (tree.links.empty()) {
    throw InputError(tree.where + ": <robot> has no <link>; add at least one");
  }
  std::vector<std::string> names;
  for (const UrdfLink& link : tree.links) names.push_back(link.name);

  for (const UrdfJoint& joint : tree.joints) {
    for (const auto& [role, link] : {std::pair{"parent", joint.parent}, {"child", joint.child}}) {
      if (!topology.links.count(link)) {
        throw InputError(joint.where + ": joint '" + joint.name + "' has the " + role + " link '" +
                         link + "', which is not there" + did_you_mean(link, names) +
                         "; name a link of the model");
      }
    }
    const auto [other, added] = topology.joint_above.emplace(joint.child, &joint);
    if (!added) {
      throw InputError(joint.where + ": link '" + joint.child + "' hangs on joint '" + joint.name +
                       "' and on '" + other->second->name + "' (" + other->second->where +
                       "); keep one of them");
    }
  }
  for (const UrdfLink& link : tree.links) {
    if (topology.joint_above.count(link.name)) continue;
    if (!topology.root.empty()) {
      throw InputError(link.where + ": link '" + link.name + "' is a second root beside '" +
                       topology.root + "'; connect it with a joint or remove it");
    }
    topology.root = link.name;
    if (link.name == "world") {
      throw InputError(link.where +
                       ": Gazebo pins a root link named 'world' to the world, which is "
                       "not modelled; give it another name");
    }
  }
  // Walking up from any link must end at the root, or at a link from where it is known to.
  std::set<std::string> rooted = {topology.root};
  for (const UrdfLink& link : tree.links) {
    std::vector<std::string> path;
    for (std::string at = link.name; !rooted.count(at);) {
      const UrdfJoint& joint = *topology.joint_above.at(at);
      if (path.size() > tree.links.size()) {
        throw InputError(joint.where + ": joint '" + joint.name +
                         "' closes a loop of links; a model must be a tree");
      }
      path.push_back(at);
      at = joint.parent;
    }
    rooted.insert(path.begin(), path.end());
  }
  return topology;
}

/// Sum of two bodies' inertias; poses are in one frame, the result's axes are that frame's.
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
    throw InputError(who + "no <inertial>; add one, or fix the link to another");
  }
  if (!(link.inertial.mass > 0)) {
    throw InputError(who + "no mass; write <mass value=\"...\"/> in kg, > 0");
  }
  if (!link.inertial.is_positive()) {
    throw InputError(who +
                     "a zero or negative moment of inertia; write an inertia in kg m^2, all "
                     "principal moments > 0");
  }
}

/// Walks the links as Gazebo does, which keeps the joints below a link sorted by name.
std::vector<std::size_t> sdf_order(const UrdfTree& tree, const std::string& root,
                                   const std::map<std::string, std::size_t>& body_of_link) {
  std::map<std::string, std::map<std::string, const UrdfJoint*>> below;
  for (const UrdfJoint& joint : tree.joints) below[joint.parent][joint.name] = &joint;
  std::vector<std::size_t> order = {body_of_link.at(root)};
  std::vector<const UrdfJoint*> ahead;
  const auto look_below = [&](const std::string& link) {
    const auto& joints = below[link];
    for (auto at = joints.rbegin(); at != joints.rend(); ++at) ahead.push_back(at->second);
  };
  for (look_below(root); !ahead.empty();) {
    const UrdfJoint& joint = *ahead.back();
    ahead.pop_back();
    if (!joint.fixed) order.push_back(body_of_link.at(joint.child));
    look_below(joint.child);
  }
  return order;
}

/// Which body carries each link, and where the link sits in it.
struct Carried {
  std::size_t body;
  Pose pose;
};

}  // namespace

Model lump(const UrdfTree& tree) {
  const Topology topology = check_topology(tree);
  Model model;
  model.name = tree.name;
  model.plugins = tree.plugins;
  model.warnings = tree.warnings;
  model.passed_over = tree.passed_over;

  std::map<std::string, Carried> carried;
  std::vector<bool> has_inertial;
  const auto add_to_body = [&](const UrdfLink& link, const Carried& place) {
    Link& body = model.links[place.body];
    if (link.inertial) {
      Inertial in_body = *link.inertial;
      in_body.pose = place.pose * in_body.pose;
      // The body's own link keeps its numbers as written; sums take the body's axes.
      const bool own = body.name == link.name;
      if (own) {
        body.inertial = *link.inertial;
      } else {
        body.inertial = combined(body.inertial, in_body);
      }
      has_inertial[place.body] = true;
    }
    for (Collision collision : link.collisions) {
      collision.pose = place.pose * collision.pose;
      body.collisions.push_back(collision);
    }
    carried[link.name] = place;
    model.body_of_link[link.name] = place.body;
  };
  const auto add_body = [&](const UrdfLink& link) {
    model.links.push_back({link.name, {}, {}, link.where});
    has_inertial.push_back(false);
    add_to_body(link, {model.links.size() - 1, Pose{}});
  };
  const auto link_named = [&](const std::string& name) -> const UrdfLink& {
    return tree.links[topology.links.at(name)];
  };

  add_body(link_named(topology.root));
  // Joints in file order, except that a parent is placed before its children.
  std::map<std::string, std::vector<std::size_t>> joints_below;
  for (std::size_t i = 0; i < tree.joints.size(); ++i) {
    joints_below[tree.joints[i].parent].push_back(i);
  }
  const std::vector<std::size_t>& first = joints_below[topology.root];
  std::set<std::size_t> ready(first.begin(), first.end());
  while (!ready.empty()) {
    const UrdfJoint& joint = tree.joints[*ready.begin()];
    ready.erase(ready.begin());
    const std::vector<std::size_t>& next = joints_below[joint.child];
    ready.insert(next.begin(), next.end());
    const Carried& parent = carried.at(joint.parent);
    const Pose pose = parent.pose * joint.pose;
    if (joint.fixed) {
      add_to_body(link_named(joint.child), {parent.body, pose});
    } else {
      model.joints.push_back({joint.name, parent.body,
                              joint.parent == model.links[parent.body].name ? joint.pose : pose,
                              joint.axis.normalized(), joint.axis, joint.damping, joint.where});
      add_body(link_named(joint.child));
    }
  }
  for (std::size_t i = 0; i < model.links.size(); ++i) check_body(model.links[i], has_inertial[i]);
  model.sdf_order = sdf_order(tree, topology.root, model.body_of_link);
  return model;
}

Model read_model(const Document& document, const std::vector<std::string>& ignore) {
  return lump(read_urdf_tree(document, ignore));
}

}  // namespace quadcore
