#pragma once

#include "vehicle.hpp"

/// \file
/// Links with collision shapes, and without inertial if need be.

namespace quadcore::test {

inline std::string shape(const std::string& geometry, const std::string& origin = "",
                         const std::string& name = "") {
  return "<collision" + (name.empty() ? "" : " name=\"" + name + "\"") + "><origin " + origin +
         "/><geometry>" + geometry + "</geometry></collision>";
}

/// A link with shapes.
inline std::string shaped(const std::string& name, const std::string& shapes,
                          const std::string& inertial = "") {
  return "<link name=\"" + name + "\">" + inertial + shapes + "</link>\n";
}

inline std::string inertial(const std::string& mass, const std::string& inertia,
                            const std::string& origin = "") {
  return "<inertial><origin " + origin + "/><mass value=\"" + mass + "\"/><inertia " + inertia +
         "/></inertial>";
}

inline const std::string ball = "<sphere radius=\"0.02\"/>";
inline const std::string turning_rotor =
    link("rotor", 0.01, round_rotor) + joint("turn", "continuous", "frame", "rotor");

}  // namespace quadcore::test
