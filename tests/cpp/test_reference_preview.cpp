#include <algorithm>
#include <optional>

#include "quadcore/control/reference_preview.hpp"
#include "vehicle.hpp"

namespace quadcore {
namespace {

using namespace test;

/// A place to stay at.
class Place final : public control::ReferenceShape {
 public:
  explicit Place(double height) : height_(height) {}
  control::Reference at(double) const override {
    control::Reference wanted;
    wanted.position.z() = height_;
    return wanted;
  }

 private:
  double height_;
};

TEST_CASE("a reference at the address of a previous one is not taken for it") {
  SimulationOptions options;
  options.engine = "eigen";
  Simulation simulation(hexarotor(), World{}, options);
  for (const char* law : {"pid", "geometric"}) {
    CAPTURE(law);
    control::ReferencePreview preview(
        control::Controller(law, simulation.describe_vehicle(), {}, {}));
    const auto list_times = [](double* times, std::size_t count) {
      std::fill_n(times, count, 0.0);
    };
    std::optional<Place> place;
    for (const double height : {10.0, 12.0, 8.0}) {
      place.emplace(height);
      CHECK(preview.at(0, *place, list_times).wanted.position.z() == height);
    }
  }
}

}  // namespace
}  // namespace quadcore
