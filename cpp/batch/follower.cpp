#include "follower.hpp"

#include "laws/variation.hpp"

namespace quadcore::batch {

std::vector<double> list_sums(const LaneNumbers& variation, std::size_t lane) {
  using Row = laws::VariationRow;
  std::vector<double> sums(variation.size() / (Row::count * widest_lanes));
  for (std::size_t i = 0; i < sums.size(); ++i) {
    sums[i] = variation[(i * Row::count + Row::sum) * widest_lanes + lane];
  }
  return sums;
}

messages::Odometry measure(const double* shown, const OdometryErrors& errors, std::uint64_t seed,
                           double draws) {
  messages::Odometry odometry;
  const auto get = [&](std::size_t row, auto&& numbers) {
    for (Eigen::Index i = 0; i < numbers.size(); ++i) {
      numbers[i] = shown[(row + static_cast<std::size_t>(i)) * widest_lanes];
    }
  };
  get(StateRow::position, odometry.position);
  get(StateRow::orientation, odometry.orientation.coeffs());
  get(StateRow::velocity, odometry.linear_velocity);
  get(StateRow::rate, odometry.angular_velocity);
  if (errors.is_none()) return odometry;
  double biases[OdometryErrors::biases] = {};
  errors.apply(odometry, 0, seed, draws, biases);
  return odometry;
}

}  // namespace quadcore::batch
