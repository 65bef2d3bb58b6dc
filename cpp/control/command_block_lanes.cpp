#include "actuation_formulas.hpp"
#include "cascade_formulas.hpp"
#include "command_block.hpp"
#include "lanes/mask.hpp"
#include "lqr_formulas.hpp"
#include "quadcore/plugin/rotor_layout.hpp"
#include "tracking_formulas.hpp"

namespace quadcore::control {
namespace {

/// Part of a table that belongs to a pack of vehicles.
template <class S, class T>
QUADCORE_LAW S& part_of(double* table, std::size_t rows, std::size_t part) {
  return *reinterpret_cast<S*>(table + part * rows * laws::lanes_of<T>);
}
template <class S, class T>
QUADCORE_LAW const S& part_of(const double* table, std::size_t rows, std::size_t part) {
  return *reinterpret_cast<const S*>(table + part * rows * laws::lanes_of<T>);
}

template <class T>
QUADCORE_LAW DemandNumbers<T> demand_by_kind(const CommandBlock& block, std::size_t part,
                                             const InputNumbers<T>& input, T* memory) {
  const double* const table = block.numbers;
  switch (block.kind) {
    case ControllerKind::cascade: {
      const auto& numbers = part_of<CascadeNumbers<T>, T>(table, block.number_rows, part);
      return demand_by_cascade(CascadeFormulas<T>{block.switches, numbers, input},
                               *reinterpret_cast<CascadeMemory<T>*>(memory));
    }
    case ControllerKind::geometric: {
      const auto& numbers = part_of<TrackingNumbers<T>, T>(table, block.number_rows, part);
      return demand_geometrically(TrackingFormulas<T>{block.switches, numbers, input},
                                  *reinterpret_cast<GeometricMemory<T>*>(memory));
    }
    case ControllerKind::indi: {
      const auto& numbers = part_of<IndiNumbers<T>, T>(table, block.number_rows, part);
      return demand_incrementally(TrackingFormulas<T>{block.switches, numbers.tracking, input},
                                  numbers.share, *reinterpret_cast<IndiMemory<T>*>(memory));
    }
    default: {
      const auto& numbers = part_of<LqrNumbers<T>, T>(table, block.number_rows, part);
      return demand_optimally(block.switches, numbers, input,
                              *reinterpret_cast<LqrMemory<T>*>(memory));
    }
  }
}

template <class T>
QUADCORE_LAW void command(const CommandBlock& block, std::size_t part) {
  using Row = ActuationRow;
  const std::size_t n = block.rotors;
  const T one = laws::broadcast<T>(1), none{};
  const RotorNumbers<T>* const rotors =
      &part_of<RotorNumbers<T>, T>(block.actuators, n * size_of<RotorNumbers>, part);
  T* const state = &part_of<T, T>(block.state, block.state_rows, part);
  RotorsNumbers<T> modelled{{none, {none, none, none}}, {none, none, none}, state[Row::saturated]};
  const bool reads_wrench = block.kind == ControllerKind::indi;
  for (std::size_t i = 0; i < n; ++i) {
    const T speed = state[Row::speeds + i];
    if (block.switches.gyroscopic) add_momentum(rotors[i], speed, modelled.h_F);
    if (reads_wrench) add_wrench(rotors[i].allocated, speed * speed, one, modelled.exerted);
  }
  const InputNumbers<T> input{
      block.period, block.begins,
      part_of<MeasuredNumbers<T>, T>(block.measured, size_of<MeasuredNumbers>, part),
      part_of<WantedNumbers<T>, T>(block.wanted, size_of<WantedNumbers>, part), modelled};
  const DemandNumbers<T> demand = demand_by_kind(block, part, input, state + Row::count(n));
  part_of<DemandNumbers<T>, T>(block.demand, size_of<DemandNumbers>, part) = demand;

  T* const speeds = &part_of<T, T>(block.speeds, n, part);
  laws::Mask<T> complete = ~laws::Mask<T>{}, reached = complete;
  for (std::size_t i = 0; i < n; ++i) {
    const T square = square_for(rotors[i].allocated, demand);
    complete &= laws::mask<T>(is_allowed(rotors[i].allocated, square, one));
    speeds[i] = laws::square_root(square);
  }
  for (std::size_t i = 0; i < n; ++i) {
    T& speed = state[Row::speeds + i];
    const LedNumbers<T> led = lead(rotors[i], speeds[i], block.begins ? speeds[i] : speed,
                                   state[Row::wanted_share], state[Row::shares(n) + i]);
    reached &= laws::mask<T>(led.excess <= largest_excess);
    speeds[i] = led.command * rotors[i].spin;
    speed = laws::chosen_by(complete, led.modelled, speed);
  }
  const auto set = [&](std::size_t row, T number) QUADCORE_INLINED {
    state[row] = laws::chosen_by(complete, number, state[row]);
  };
  set(Row::begun, one);
  set(Row::saturated, laws::chosen_by(reached, none, one));
  laws::store_bits<T>(block.complete + part * laws::lanes_of<T>, complete);
}

}  // namespace

template <int W>
void command_block(const CommandBlock& block) {
  for (std::size_t part = 0; part * W < block.vehicles; ++part) {
    command<laws::Pack<W>>(block, part);
  }
}

template <int W>
void command_single(const CommandBlock& block) {
  command<double>(block, 0);
}

template void command_block<QUADCORE_LANES>(const CommandBlock&);
template void command_single<QUADCORE_LANES>(const CommandBlock&);

}  // namespace quadcore::control
