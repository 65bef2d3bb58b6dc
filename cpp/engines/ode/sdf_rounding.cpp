#include "sdf_rounding.hpp"

#include <cstdlib>
#include <iomanip>
#include <locale>
#include <sstream>

#include "quadcore/error.hpp"

namespace quadcore {
namespace {

double printed(double value, bool fixed, int precision) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  if (fixed) out << std::fixed;
  out << std::setprecision(precision) << value;
  std::istringstream in(out.str());
  in.imbue(std::locale::classic());
  in >> value;
  return value;
}

double scalar(double value) { return printed(value, false, 6); }

double component(double value) { return scalar(printed(value, true, 6)); }

Vector3d components(const Vector3d& v) {
  return {component(v.x()), component(v.y()), component(v.z())};
}

Pose pose(const Pose& p) { return {components(p.xyz), components(p.rpy)}; }

}  // namespace

Model rounded_like_sdf(Model model) {
  for (Link& link : model.links) {
    link.inertial.mass = scalar(link.inertial.mass);
    link.inertial.pose = pose(link.inertial.pose);
    link.inertial.inertia = link.inertial.inertia.unaryExpr(&scalar);
    if (!link.inertial.is_positive()) {
      throw InputError(link.where + ": link '" + link.name +
                       "': rounded to 6 digits, as Gazebo does, its inertia has a zero or negative "
                       "principal moment; write one whose principal moments differ less, or use "
                       "the engine ode");
    }
    for (Collision& collision : link.collisions) {
      collision.pose = pose(collision.pose);
      collision.size = collision.size.unaryExpr(&scalar);
    }
  }
  for (Joint& joint : model.joints) {
    joint.pose = pose(joint.pose);
    joint.axis = components(joint.axis_as_written).normalized();
    if (joint.axis.isZero(0)) {
      throw InputError(joint.where + ": joint '" + joint.name +
                       "': rounded to 6 decimals, as Gazebo does, its axis is zero; write it with "
                       "length 1");
    }
    joint.damping = scalar(joint.damping);
  }
  return model;
}

}  // namespace quadcore
