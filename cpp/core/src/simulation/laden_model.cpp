#include "laden_model.hpp"

#include <cmath>
#include <string>

#include "lumping.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore {
namespace {

bool operator==(const Pose& a, const Pose& b) { return a.xyz == b.xyz && a.rpy == b.rpy; }

bool operator==(const Inertial& a, const Inertial& b) {
  return a.mass == b.mass && a.pose == b.pose && a.inertia == b.inertia;
}

bool is_finite(const Pose& pose) { return pose.xyz.allFinite() && pose.rpy.allFinite(); }

}  // namespace

bool operator==(const CarriedBody& a, const CarriedBody& b) {
  return a.name == b.name && a.pose == b.pose && a.inertial == b.inertial;
}

void check_carried(const std::vector<CarriedBody>& bodies, std::size_t i, const Model& model) {
  const CarriedBody& body = bodies[i];
  const std::string name(body.name);
  const auto refuse = [&name](const std::string& why) {
    throw Error("the carried body '" + name + "' " + why);
  };
  const Inertial& inertial = body.inertial;
  if (name.empty()) refuse("has no name. Give it one.");
  if (model.body_of_link.count(name)) refuse("has the name of a link. Give it another name.");
  for (std::size_t k = 0; k < i; ++k) {
    if (bodies[k].name == body.name)
      refuse("has the name of another carried body. Give it another name.");
  }
  if (!(inertial.mass > 0 && std::isfinite(inertial.mass)))
    refuse("has no mass. Give a positive mass in kg.");
  if (!is_finite(body.pose) || !is_finite(inertial.pose))
    refuse("has a pose that is not finite. Give m and rad.");
  const Matrix3d& I = inertial.inertia;
  if (!I.allFinite() || I != I.transpose() || inertial.principal_moments()[0] < -1e-12 * I.norm()) {
    refuse(
        "has an impossible inertia. Give a symmetric one in kg m^2 without negative principal "
        "moments.");
  }
}

Model with_carried(const Model& model, const std::vector<CarriedBody>& bodies) {
  if (bodies.empty()) return model;
  const auto tree = std::make_shared<UrdfTree>(*model.urdf);
  for (const CarriedBody& body : bodies) {
    UrdfLink link;
    link.name = std::string(body.name);
    link.inertial = body.inertial;
    UrdfJoint joint;
    joint.name = joint.child = link.name;
    joint.fixed = true;
    joint.parent = tree->root;
    joint.pose = body.pose;
    tree->links.push_back(link);
    tree->joints.push_back(joint);
  }
  Model carrying = lump(*tree);
  carrying.urdf = tree;
  return carrying;
}

}  // namespace quadcore
