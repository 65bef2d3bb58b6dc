#pragma once

#include <cstddef>
#include <type_traits>

#include "lanes/pack.hpp"
#include "quadcore/lane_laws.hpp"

namespace quadcore {

/// A list of force laws of one kind.
template <class Law>
struct Laws {
  const Law* first;
  std::size_t count;

  /// Call work with each law. Most vehicles have one, which stays in registers without a loop.
  template <class Work>
  QUADCORE_LAW void for_each(const Work& work) const {
    if (__builtin_expect(count == 1, 1)) {
      work(*first);
    } else {
      for (std::size_t i = 0; i < count; ++i) work(first[i]);
    }
  }
};

/// The force laws that an engine evaluates itself, see ForceLaws.
struct LawViews {
  Laws<RotorForces> rotor_forces;
  Laws<FrameDrag> frame_drags;
  Laws<AirframeLaws> airframes;
  Laws<MotorTorques> motor_torques;
};

/// Return views of the lists of ForceLaws, which this header does not include.
template <class Lists>
LawViews views_of(const Lists& lists) {
  const auto list = [](const auto& laws) {
    return Laws<std::decay_t<decltype(laws[0])>>{laws.data(), laws.size()};
  };
  return {list(lists.rotor_forces), list(lists.frame_drags), list(lists.airframes),
          list(lists.motor_torques)};
}

}  // namespace quadcore
