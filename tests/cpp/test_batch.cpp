#include "quadcore/batch.hpp"
#include "vehicle.hpp"

namespace quadcore {
namespace {

using namespace test;

TEST_CASE("a batch follows only as many guides and flights as it has vehicles") {
  const auto six = std::make_shared<const Model>(hexarotor());
  SimulationOptions options;
  options.engine = "eigen";
  Batch batch({{six}, {six}}, World{}, options, 1);
  const auto follow = [&](std::size_t guides, std::size_t flights) {
    std::vector<BatchGuided> guided(flights);
    batch.follow(std::vector<BatchGuide>(guides), "odom", 5, 1, guided, [] {});
  };
  CHECK(contains(refusal([&] { follow(1, 2); }), "there are 1 controllers for 2 vehicles"));
  CHECK(contains(refusal([&] { follow(2, 3); }), "there are 3 flights for 2 vehicles"));
  CHECK(batch.time(1) == 0);
}

}  // namespace
}  // namespace quadcore
