#include "sdf_conversion.hpp"

#include <set>

#include "lumping.hpp"
#include "quadcore/plugin/error.hpp"
#include "sdf_lumping.hpp"

namespace quadcore {
namespace {

/// Mass up to which sdformat drops a link and everything attached to it [kg].
constexpr double lost_mass = 1e-6;

class Conversion {
 public:
  explicit Conversion(const UrdfTree& tree) : tree_(tree), links_(sdf_links(tree)) {
    for (const UrdfLink& link : tree.links) by_name_[link.name] = &link;
    for (std::size_t i = 0; i < links_.size(); ++i) {
      for (std::size_t k = 0; k < links_[i].parts.size(); ++k) {
        place_[links_[i].parts[k].link] = {i, k};
      }
      carries_.emplace_back(links_[i].parts.size());
    }
    for (const SdfLink& link : links_) {
      if (!link.joint) continue;
      auto [at, part] = place_.at(link.joint->parent);
      for (; !carries_[at][part]; part = links_[at].parts[part].parent) {
        carries_[at][part] = link.joint;
      }
    }
  }

  /// Put locked joints first, the only ones that are still to be lumped. lump() then keeps the
  /// others in the order of `joints`, even if they are attached to links behind locked joints.
  UrdfTree convert(const std::vector<Joint>& joints) {
    UrdfTree sdf;
    sdf.name = tree_.name;
    sdf.where = tree_.where;
    sdf.root = tree_.root;
    std::map<std::string, const UrdfJoint*> turning;
    for (const SdfLink& link : links_) {
      sdf.links.push_back(converted(link));
      if (!link.joint) continue;
      if (link.joint->locked) {
        sdf.joints.push_back(converted(*link.joint));
      } else {
        turning[link.joint->name] = link.joint;
      }
    }
    for (const Joint& joint : joints) sdf.joints.push_back(converted(*turning.at(joint.name)));
    return sdf;
  }

 private:
  UrdfLink converted(const SdfLink& link) {
    const UrdfLink& own = *by_name_.at(link.parts.front().link);
    UrdfLink result{own.name, {}, {}, own.where, own.tags};
    result.tags.damping_factor = sdf_scalar(own.tags.damping_factor);
    const std::optional<SdfInertial> sum = lumped(link);
    if (!sum || sum->mass <= lost_mass) return result;  // nothing is attached to it
    result.inertial =
        Inertial{sdf_scalar(sum->mass), sdf_pose(sum->pose), sum->inertia.unaryExpr(&sdf_scalar)};
    const bool moves = !link.joint || !link.joint->locked;
    if (moves && !result.inertial->is_positive()) {
      throw InputError(
          own.where + ": link '" + own.name +
          "': after rounding to 6 digits, as in Gazebo, its inertia has a zero or negative "
          "principal moment. Make the principal moments differ less, or use the engine ode.");
    }
    for (std::size_t i = 0; i < link.parts.size(); ++i) {
      for (const Collision& shape : by_name_.at(link.parts[i].link)->collisions) {
        result.collisions.push_back(converted(shape, lifted(link, i, SdfPose(shape.pose))));
      }
    }
    return result;
  }

  static Collision converted(Collision shape, const SdfPose& pose) {
    shape.pose = sdf_shape_pose(pose);
    if (shape.kind == ShapeKind::box) {
      shape.size = sdf_vector(shape.size);
    } else {
      shape.size = shape.size.unaryExpr(&sdf_scalar);
    }
    if (shape.kind != ShapeKind::mesh && !(shape.size.minCoeff() > 0)) {
      throw InputError(shape.where +
                       ": after rounding to 6 decimals, as in Gazebo, the box is flat. Use sides "
                       "of at least 1e-6 m, or the engine ode.");
    }
    Surface& surface = shape.surface;
    for (double* number : {&surface.mu1, &surface.mu2, &surface.kp, &surface.kd, &surface.min_depth,
                           &surface.max_vel}) {
      *number = sdf_scalar(*number);
    }
    surface.fdir1 = sdf_vector(surface.fdir1);
    return shape;
  }

  UrdfJoint converted(UrdfJoint joint) const {
    const auto& [link, part] = place_.at(joint.parent);
    joint.pose = sdf_pose(lifted(links_[link], part, SdfPose(joint.pose)));
    joint.parent = links_[link].parts.front().link;
    joint.axis = sdf_vector(joint.axis);
    if (joint.axis.isZero(0)) {
      throw InputError(joint.where + ": joint '" + joint.name +
                       "': after rounding to 6 decimals, as in Gazebo, its axis is zero. Write an "
                       "axis of length 1.");
    }
    joint.damping = sdf_scalar(joint.damping);
    joint.friction = sdf_scalar(joint.friction);
    return joint;
  }

  /// Return a pose in a part relative to the link's own part.
  static SdfPose lifted(const SdfLink& link, std::size_t part, SdfPose pose) {
    for (; part != 0; part = link.parts[part].parent) {
      pose = SdfPose(link.parts[part].joint->pose) * pose;
    }
    return pose;
  }

  /// Sum up the parts, the farthest first. Gazebo drops a part that still has no mass.
  std::optional<SdfInertial> lumped(const SdfLink& link) {
    std::vector<std::optional<SdfInertial>> sums;
    std::vector<std::vector<std::size_t>> fixed_to(link.parts.size());
    for (std::size_t i = 0; i < link.parts.size(); ++i) {
      const std::optional<Inertial>& own = by_name_.at(link.parts[i].link)->inertial;
      sums.emplace_back();
      if (own) sums.back() = SdfInertial{own->mass, SdfPose(own->pose), own->inertia};
      if (i > 0) fixed_to[link.parts[i].parent].push_back(i);
    }
    for (std::size_t i = sums.size(); i-- > 0;) {
      for (const std::size_t child : fixed_to[i]) {
        if (!sums[child]) continue;
        if (!sums[i]) sums[i].emplace();
        sums[i]->add(*sums[child], SdfPose(link.parts[child].joint->pose));
      }
      if (!sums[i] || sums[i]->mass <= lost_mass) refuse_to_lose(link, i);
    }
    return sums.front();
  }

  /// Throw InputError if a joint of the model would be dropped with the part.
  void refuse_to_lose(const SdfLink& link, std::size_t part) const {
    const std::string& name = link.parts[part].link;
    const bool turns = link.joint && part == 0 && !link.joint->locked;
    const UrdfJoint* lost = turns ? link.joint : carries_[place_.at(name).first][part];
    if (!lost) return;
    throw InputError(by_name_.at(name)->where + ": link '" + name +
                     "', including the links fixed to it, has at most 1e-6 kg, so Gazebo silently "
                     "drops it with joint '" +
                     lost->name + "' (" + lost->where +
                     "). Give it more than 1e-6 kg, attach the joint to another link, or use the "
                     "engine ode or eigen.");
  }

  const UrdfTree& tree_;
  std::vector<SdfLink> links_;
  std::map<std::string, const UrdfLink*> by_name_;
  std::map<std::string, std::pair<std::size_t, std::size_t>>
      place_;                                           ///< position of each URDF link
  std::vector<std::vector<const UrdfJoint*>> carries_;  ///< a joint attached to each part
};

}  // namespace

Model converted_to_sdf(const Model& model) {
  Model sdf = lump(Conversion(*model.urdf).convert(model.joints));
  Model converted = model;
  converted.links = std::move(sdf.links);
  converted.joints = std::move(sdf.joints);
  for (const auto& [link, pose] : sdf.pose_of_link) converted.pose_of_link[link] = pose;
  converted.source.reset();  // the source would be read without rounding
  return converted;
}

Bodies sdf_bodies(const Model& model) {
  UrdfTree sdf = Conversion(*model.urdf).convert(model.joints);
  std::map<std::string, const UrdfLink*> links;
  for (const UrdfLink& link : sdf.links) links[link.name] = &link;
  std::vector<std::string> warnings;
  for (UrdfJoint& joint : sdf.joints) {
    const UrdfLink& link = *links.at(joint.child);
    if (!joint.locked || !link.inertial) continue;  // Gazebo drops a link without mass
    joint.fixed = !link.inertial->is_positive();
    if (!joint.fixed) continue;
    warnings.push_back(link.where + ": link '" + link.name + "' behind the locked joint '" +
                       joint.name +
                       "' has a zero or negative principal moment of inertia and moves as if it "
                       "were fixed. Write an <inertia> with positive principal moments.");
  }
  Model bodies = lump(sdf);
  bodies.urdf = model.urdf;
  bodies.warnings = std::move(warnings);
  std::set<std::string> turning;
  for (const Joint& joint : model.joints) turning.insert(joint.name);
  std::vector<std::size_t> rotors;
  for (std::size_t i = 0; i < bodies.joints.size(); ++i) {
    if (turning.count(bodies.joints[i].name)) rotors.push_back(i);
  }
  return {std::move(bodies), std::move(rotors)};
}

std::vector<std::size_t> sdf_order(const Model& model) {
  std::vector<std::size_t> order;
  for (const SdfLink& link : sdf_links(*model.urdf)) {
    const std::string& name = link.parts.front().link;
    const std::size_t body = model.body_of_link.at(name);
    if (model.links[body].name == name) order.push_back(body);  // otherwise it is lumped
  }
  return order;
}

}  // namespace quadcore
