#pragma once

#include <doctest/doctest.h>

#include <string>

#include "quadcore/plugin/error.hpp"
#include "quadcore/plugin/model.hpp"
#include "quadcore/plugin/world.hpp"
#include "quadcore/simulation.hpp"

/// \file
/// Small documents for the tests, and what they expect of errors.

namespace quadcore::test {

/// A link with an inertial; `inertia` holds the six attributes.
inline std::string link(const std::string& name, double mass, const std::string& inertia,
                        const std::string& origin = "xyz=\"0 0 0\"") {
  return "<link name=\"" + name + "\"><inertial><origin " + origin + "/><mass value=\"" +
         std::to_string(mass) + "\"/><inertia " + inertia + "/></inertial></link>\n";
}

inline std::string joint(const std::string& name, const std::string& type,
                         const std::string& parent, const std::string& child,
                         const std::string& origin = "xyz=\"0 0 0\"") {
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent +
         "\"/><child link=\"" + child + "\"/><origin " + origin +
         "/><axis xyz=\"0 0 1\"/></joint>\n";
}

inline const std::string round_body =
    "ixx=\"0.01\" iyy=\"0.01\" izz=\"0.02\" ixy=\"0\" ixz=\"0\" iyz=\"0\"";
inline const std::string round_rotor =
    "ixx=\"1e-5\" iyy=\"1e-5\" izz=\"2e-5\" ixy=\"0\" ixz=\"0\" iyz=\"0\"";
inline const std::string skew_body =
    "ixx=\"0.012\" iyy=\"0.014\" izz=\"0.021\" ixy=\"0.0004\" ixz=\"-0.0003\" iyz=\"0.0002\"";

inline Document robot(const std::string& inside) {
  return {"test.urdf", "<robot name=\"test\">\n" + inside + "</robot>\n"};
}

inline Model model(const std::string& inside) { return read_model(robot(inside)); }

/// The six-rotor model of the recordings: fixed arms, offset centre of mass, tilted rotors.
inline Model hexarotor() {
  return read_model(Document::read(TEST_DATA "/gazebo11/cases/B1_hexa_hover/model.urdf"));
}

/// Neither force nor torque.
class NoForces final : public ForceField {
 public:
  void evaluate(Kinematics&, Loads&) const override {}
};

/// Message of the InputError that `call` throws.
template <typename Call>
std::string refusal(const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  FAIL("nothing was refused");
  return "";
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace quadcore::test
