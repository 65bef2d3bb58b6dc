#include "block.hpp"
#include "lanes/table.hpp"
#include "laws/measurement.hpp"
#include "laws/random.hpp"
#include "measure_block.hpp"
#include "measured_numbers.hpp"

namespace quadcore::batch {
namespace {

using control::MeasuredNumbers;

template <class T>
QUADCORE_LAW void measure(const MeasureBlock& block, std::size_t part) {
  constexpr std::size_t width = laws::lanes_of<T>;
  constexpr std::size_t error_rows = sizeof(ErrorNumbers<double>) / sizeof(double),
                        measured_rows = sizeof(MeasuredNumbers<double>) / sizeof(double);
  const auto& errors =
      *reinterpret_cast<const ErrorNumbers<T>*>(block.errors + part * error_rows * width);
  laws::UnsignedOf<T> seeds, counts;
  __builtin_memcpy(&seeds, block.seeds + part * width, sizeof seeds);
  __builtin_memcpy(&counts, block.begins + part * width, sizeof counts);
  counts += block.count;
  const auto measured = [&](const laws::Vec3<T>& truth, int quantity) QUADCORE_INLINED {
    laws::Vec3<T> a = truth;
    if (block.is_noisy[quantity]) {
      a = a + errors.noise[quantity] * laws::random_vector<T>(seeds, counts);
    }
    return block.is_quantised[quantity] ? laws::quantised(a, errors.resolution[quantity]) : a;
  };
  const laws::Table<T, widest_lanes> shown{block.shown + part * width};
  const auto row = [&](std::size_t i)
                       QUADCORE_INLINED { return shown.number(StateRow::orientation + i); };
  auto& to = *reinterpret_cast<MeasuredNumbers<T>*>(block.measured + part * measured_rows * width);
  to.position = measured(shown.vector(StateRow::position), 0);
  to.q_WF = {row(0), row(1), row(2), row(3)};
  if (block.is_noisy[1] || block.is_quantised[1]) {
    to.q_WF = laws::turned_in_body(to.q_WF, measured({T{}, T{}, T{}}, 1));
  }
  to.v_WF_W = measured(shown.vector(StateRow::velocity), 2);
  to.w_WF_F = measured(shown.vector(StateRow::rate), 3);
}

}  // namespace

template <int W>
void measure_block(const MeasureBlock& block) {
  for (std::size_t part = 0; part < widest_lanes / W; ++part) measure<laws::Pack<W>>(block, part);
}

template void measure_block<QUADCORE_LANES>(const MeasureBlock&);

}  // namespace quadcore::batch
