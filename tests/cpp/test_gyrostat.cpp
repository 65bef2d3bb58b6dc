#include "shapes.hpp"

using namespace quadcore;
using namespace quadcore::test;

namespace {

/// A rotor about z whose centre of mass is so far off the axis [m], with such moments about x.
Model with_rotor(const std::string& offset, const std::string& ixx) {
  return model(link("frame", 1, skew_body) +
               link("rotor", 0.01,
                    "ixx=\"" + ixx + "\" iyy=\"1e-5\" izz=\"2e-5\" ixy=\"0\" ixz=\"0\" iyz=\"0\"",
                    "xyz=\"" + offset + " 0 0.02\"") +
               joint("turn", "continuous", "frame", "rotor", "xyz=\"0.1 0.2 0\""));
}

}  // namespace

TEST_CASE("eigen takes a rotor within a nanometre of its axis, and as round as floats can tell") {
  make_engine("eigen", with_rotor("1e-9", "1e-5"), World{});
  CHECK(contains(refusal([&] { make_engine("eigen", with_rotor("1.1e-9", "1e-5"), World{}); }),
                 "the centre of mass of 'rotor' lies off the axis"));
  const auto warnings = [](const std::string& ixx) {
    return make_engine("eigen", with_rotor("0", ixx), World{})->warnings();
  };
  // Of the norm of the inertia, 2.45e-5; the deviation is split between x and y.
  CHECK(warnings("1.0000033e-5").empty());
  CHECK(contains(warnings("1.0000037e-5").at(0), "averages the inertia of rotor over a turn"));
}

TEST_CASE("eigen refuses the least friction in a joint") {
  std::string turning = turning_rotor;
  turning.insert(turning.find("</joint>"), "<dynamics friction=\"1e-9\"/>");
  const Model m = model(link("frame", 1, skew_body) + turning);
  CHECK(contains(refusal([&] { make_engine("eigen", m, World{}); }), "joint 'turn' has friction"));
}

TEST_CASE("eigen minds a collision mesh only where there is ground to touch") {
  const Model m =
      model(shaped("frame", shape("<mesh filename=\"hull.stl\"/>"), inertial("1", skew_body)) +
            turning_rotor);
  make_engine("eigen", m, World{});
  World world;
  world.ground_plane = true;
  CHECK(contains(refusal([&] { make_engine("eigen", m, world); }), "a collision mesh"));
}
