#include <set>

#include "quadcore/plugin/error.hpp"
#include "quadcore/text.hpp"
#include "quadcore/urdf_tree.hpp"

namespace quadcore {
namespace {

template <typename Named>
std::map<std::string, std::size_t> index_by_name(const std::vector<Named>& items,
                                                 const std::string& kind) {
  std::map<std::string, std::size_t> index;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const auto [first, added] = index.emplace(items[i].name, i);
    if (!added) {
      throw InputError(items[i].where + ": a second " + kind + " is named '" + items[i].name +
                       "' (first at " + items[first->second].where + "). Give it another name.");
    }
  }
  return index;
}

}  // namespace

void check_topology(UrdfTree& tree) {
  std::map<std::string, const UrdfJoint*> joint_above;
  const auto links = index_by_name(tree.links, "link");
  index_by_name(tree.joints, "joint");
  if (tree.links.empty()) {
    throw InputError(tree.where + ": <robot> has no <link>. Add at least one.");
  }
  std::vector<std::string> names;
  for (const UrdfLink& link : tree.links) names.push_back(link.name);

  for (const UrdfJoint& joint : tree.joints) {
    for (const auto& [role, link] : {std::pair{"parent", joint.parent}, {"child", joint.child}}) {
      if (!links.count(link)) {
        throw InputError(joint.where + ": the " + role + " link '" + link + "' of joint '" +
                         joint.name + "' does not exist." + suggest(link, names) +
                         " Name a link of the model.");
      }
    }
    const auto [other, added] = joint_above.emplace(joint.child, &joint);
    if (!added) {
      throw InputError(joint.where + ": link '" + joint.child + "' is the child of joint '" +
                       joint.name + "' and of '" + other->second->name + "' (" +
                       other->second->where + "). Keep one of them.");
    }
  }
  for (const UrdfLink& link : tree.links) {
    if (joint_above.count(link.name)) continue;
    if (!tree.root.empty()) {
      throw InputError(link.where + ": link '" + link.name + "' is a second root next to '" +
                       tree.root + "'. Connect it with a joint or remove it.");
    }
    tree.root = link.name;
    if (link.name == "world") {
      throw InputError(link.where +
                       ": Gazebo fixes a root link named 'world' to the world, which is not "
                       "modelled. Give the link another name.");
    }
  }
  // The way up from any link must end at the root or at a link that is known to lead there.
  std::set<std::string> rooted = {tree.root};
  for (const UrdfLink& link : tree.links) {
    std::set<std::string> path;
    for (std::string at = link.name; !rooted.count(at);) {
      const UrdfJoint& joint = *joint_above.at(at);
      if (!path.insert(at).second) {
        throw InputError(joint.where + ": joint '" + joint.name +
                         "' closes a loop of links. Remove a joint to make the model a tree.");
      }
      at = joint.parent;
    }
    rooted.insert(path.begin(), path.end());
  }
}

JointsBelow joints_below(const UrdfTree& tree) {
  JointsBelow below;
  for (const UrdfJoint& joint : tree.joints) below[joint.parent][joint.name] = &joint;
  return below;
}

std::vector<SdfLink> sdf_links(const UrdfTree& tree) {
  JointsBelow below = joints_below(tree);
  /// A joint still to be visited and the part that carries it.
  struct Ahead {
    const UrdfJoint* joint;
    std::size_t link, part;
  };
  std::vector<SdfLink> links = {{{{tree.root, nullptr, 0}}}};
  std::vector<Ahead> ahead;
  const auto look_below = [&](std::size_t link, std::size_t part) {
    const auto& joints = below[links[link].parts[part].link];
    for (auto at = joints.rbegin(); at != joints.rend(); ++at) {
      ahead.push_back({at->second, link, part});
    }
  };
  for (look_below(0, 0); !ahead.empty();) {
    const Ahead next = ahead.back();
    ahead.pop_back();
    if (next.joint->fixed && !next.joint->locked) {
      auto& parts = links[next.link].parts;
      parts.push_back({next.joint->child, next.joint, next.part});
      look_below(next.link, parts.size() - 1);
    } else {
      links.push_back({{{next.joint->child, nullptr, 0}}, next.joint});
      look_below(links.size() - 1, 0);
    }
  }
  return links;
}

}  // namespace quadcore
