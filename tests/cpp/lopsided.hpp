#pragma once

#include <cstdio>

#include "vehicle.hpp"

/// \file
/// A vehicle on which no mistake cancels.

namespace quadcore::test {

inline std::string text(const Vector3d& v) {
  char line[80];
  std::snprintf(line, sizeof line, "%.17g %.17g %.17g", v.x(), v.y(), v.z());
  return line;
}

/// A rotor on a hinge that is neither upright nor through the rotor's origin.
inline std::string rotor(const std::string& name, const std::string& parent,
                         const std::string& origin, const Vector3d& axis, const Vector3d& center,
                         const Matrix3d& I, double damping, double friction) {
  char inertia[200];
  std::snprintf(
      inertia, sizeof inertia,
      "ixx=\"%.17g\" iyy=\"%.17g\" izz=\"%.17g\" ixy=\"%.17g\" ixz=\"%.17g\" iyz=\"%.17g\"",
      I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2));
  return link(name, 0.03, inertia, "xyz=\"" + text(center) + "\"") + "<joint name=\"turns_" + name +
         "\" type=\"continuous\"><parent link=\"" + parent + "\"/><child link=\"" + name +
         "\"/><origin " + origin + "/><axis xyz=\"" + text(axis) + "\"/><dynamics damping=\"" +
         std::to_string(damping) + "\" friction=\"" + std::to_string(friction) + "\"/></joint>\n";
}

/// Three unlike rotors, tilted, each with its centre of mass on its axis but off its origin, and
/// with an inertia that is symmetric about the axis. `skew` ones are a blade that is neither, and
/// the last hangs on the second.
inline Model lopsided(bool skew, double friction = 0, int rotors = 3) {
  std::string parts = link("frame", 1.2, skew_body, "xyz=\"0.02 -0.03 0.01\" rpy=\"0.3 -0.2 0.5\"");
  const Vector3d axes[] = {{0, 0.6, 0.8}, {0.48, 0.6, -0.64}, {-0.8, 0, 0.6}};
  const char* origins[] = {"xyz=\"0.2 0.03 0.05\" rpy=\"0.2 0.1 -0.4\"",
                           "xyz=\"-0.15 0.1 0.02\" rpy=\"-0.3 0.2 1\"",
                           "xyz=\"0.01 -0.22 -0.04\" rpy=\"0.1 -0.2 2\""};
  for (int i = 0; i < rotors; ++i) {
    const Vector3d& a = axes[i % 3];
    const Matrix3d I = (2e-5 + 4e-6 * i) * Matrix3d::Identity() + 1.5e-5 * a * a.transpose();
    Matrix3d blade = Matrix3d::Constant(2e-6);
    blade.diagonal() << 1.2e-5 + 3e-6 * i, 2.7e-5, 3.2e-5;
    const Vector3d center = (0.01 + 0.005 * i) * a;
    parts +=
        rotor(std::string(1, static_cast<char>('a' + i)), skew && i == 2 ? "b" : "frame",
              origins[i % 3], a, skew ? Vector3d(center + Vector3d(0.004, -0.003, 0.002)) : center,
              skew ? blade : I, 1e-5 * (i + 1), friction);
  }
  return model(parts);
}

}  // namespace quadcore::test
