#include "references.hpp"

#include <algorithm>
#include <functional>

#include "quadcore/plugin/error.hpp"
#include "quadcore/text.hpp"

namespace quadcore {
namespace {

const std::map<std::string, void (*)(Surface&, const Vector3d&)>& surface_tags() {
  static const std::map<std::string, void (*)(Surface&, const Vector3d&)> setters = {
      {"mu1", [](Surface& s, const Vector3d& v) { s.mu1 = v.x(); }},
      {"mu2", [](Surface& s, const Vector3d& v) { s.mu2 = v.x(); }},
      {"fdir1", [](Surface& s, const Vector3d& v) { s.fdir1 = v; }},
      {"kp", [](Surface& s, const Vector3d& v) { s.kp = v.x(); }},
      {"kd", [](Surface& s, const Vector3d& v) { s.kd = v.x(); }},
      {"minDepth", [](Surface& s, const Vector3d& v) { s.min_depth = v.x(); }},
      {"maxVel", [](Surface& s, const Vector3d& v) { s.max_vel = v.x(); }},
      {"maxContacts",
       [](Surface& s, const Vector3d& v) { s.max_contacts = static_cast<int>(v.x()); }},
  };
  return setters;
}

const GivenTag* tag_of(const GazeboReference& reference, const std::string& name) {
  for (const GivenTag& tag : reference.tags) {
    if (tag.name == name) return &tag;
  }
  return nullptr;
}

/// A tag with an effect must name a link or joint that it applies to.
void check_names(const UrdfTree& tree) {
  std::map<std::string, std::vector<std::string>> names;
  for (const UrdfLink& link : tree.links) names["link"].push_back(link.name);
  for (const UrdfJoint& joint : tree.joints) names["joint"].push_back(joint.name);
  std::map<std::string, std::string> of;
  for (const GazeboTag& tag : gazebo_tags()) of[tag.name] = tag.of;
  for (const GazeboReference& reference : tree.references) {
    for (const GivenTag& tag : reference.tags) {
      const std::string& kind = of.at(tag.name);
      const std::vector<std::string>& known = names[kind];
      if (std::find(known.begin(), known.end(), reference.name) != known.end()) continue;
      throw InputError(tag.where + ": <" + tag.name + "> applies to a " + kind +
                       ", but the model has no " + kind + " '" + reference.name + "'." +
                       suggest(reference.name, known) + " Name a " + kind + " of the model.");
    }
  }
}

/// A link of a body and the references to the link.
struct Part {
  UrdfLink* link;
  std::vector<const GazeboReference*> references;
};

class Body {
 public:
  explicit Body(std::vector<Part> parts) : parts_(std::move(parts)) {
    for (const Part& part : parts_) {
      all_.insert(all_.end(), part.references.begin(), part.references.end());
    }
  }

  /// Gazebo sets gravity again with each reference and uses the first damping only.
  void set_tags(std::vector<std::string>& warnings) {
    BodyTags& tags = parts_.front().link->tags;
    for (const GazeboReference* reference : all_) {
      if (const GivenTag* off = tag_of(*reference, "turnGravityOff")) {
        if (reference == all_.back()) {
          tags.gravity = off->value.x() == 0;
          if (!tags.gravity) tags.where = off->where;
        } else if (off->value.x() != 0) {
          warnings.push_back(off->where +
                             ": <turnGravityOff> has no effect, as in Gazebo, because a later "
                             "<gazebo reference> of the same body (" +
                             all_.back()->where + ") turns gravity on again. Move the tag there.");
        }
      }
      if (const GivenTag* factor = tag_of(*reference, "dampingFactor")) {
        if (reference == all_.front()) {
          tags.damping_factor = factor->value.x();
          if (tags.damping_factor != 0) tags.where = factor->where;
        } else if (factor->value.x() != 0) {
          warnings.push_back(factor->where +
                             ": <dampingFactor> has no effect, as in Gazebo, because only the "
                             "first <gazebo reference> of a body counts (" +
                             all_.front()->where + "). Move the tag there.");
        }
      }
    }
  }

  /// Gazebo assigns tags to shapes by the names that it generates for them. The number that it
  /// appends to all but the first name makes no difference here.
  void set_surfaces(std::vector<std::string>& warnings) {
    const std::string lumped = "_fixed_joint_lump__", suffix = "_collision";
    const std::string& base = parts_.front().link->name;
    for (const Part& part : parts_) {
      for (Collision& shape : part.link->collisions) {
        std::string name = (shape.name.empty() ? part.link->name : shape.name) + suffix;
        if (name.compare(0, base.size(), base) != 0) name = base + lumped + name;
        for (const GazeboReference* reference : all_) {
          const bool own = reference->name == base;
          const bool applies =
              own ? name.find(lumped) == std::string::npos
                  : name.find(lumped + reference->name + suffix) != std::string::npos;
          bool any = false;
          for (const GivenTag& tag : reference->tags) {
            const auto setter = surface_tags().find(tag.name);
            if (setter == surface_tags().end()) continue;
            any = true;
            if (applies) setter->second(shape.surface, tag.value);
          }
          if (!any || applies == (reference->name == part.link->name)) continue;
          warnings.push_back(shape.where + ": because of its name, this shape of link '" +
                             part.link->name + (applies ? "' takes" : "' does not take") +
                             " the contact tags of link '" + reference->name + "' (" +
                             reference->where +
                             "), as in Gazebo. Remove the shape's name, and start no link's name "
                             "with that of the link it is fixed to.");
        }
      }
    }
  }

 private:
  std::vector<Part> parts_;
  std::vector<const GazeboReference*> all_;
};

}  // namespace

void apply_references(UrdfTree& tree) {
  if (tree.references.empty()) return;
  check_names(tree);
  std::map<std::string, UrdfLink*> links;
  for (UrdfLink& link : tree.links) links[link.name] = &link;
  std::map<std::string, std::vector<const GazeboReference*>> references;
  for (const GazeboReference& r : tree.references) references[r.name].push_back(&r);
  for (UrdfJoint& joint : tree.joints) {
    for (const GazeboReference* reference : references[joint.name]) {
      const GivenTag* tag = tag_of(*reference, "implicitSpringDamper");
      if (tag) joint.implicit_damping = tag->value.x() != 0;
    }
  }
  for (const SdfLink& sdf_link : sdf_links(tree)) {
    std::vector<Part> parts;
    for (const SdfLink::Part& part : sdf_link.parts) {
      parts.push_back({links.at(part.link), references[part.link]});
    }
    Body body(std::move(parts));
    body.set_tags(tree.warnings);
    body.set_surfaces(tree.warnings);
  }
}

}  // namespace quadcore
