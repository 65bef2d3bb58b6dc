#pragma once

#include "lanes/vec3.hpp"
#include "quadcore/plugin/rotor_layout.hpp"

namespace quadcore::laws {

/// Number of rotors of a vehicle in a pack, in code for lanes of width W. Most vehicles fit in four
/// lanes; eight would be half empty, but the processors that have them have 32 registers for four.
template <int W>
constexpr int rotors_in_pack = W < 4 ? W : 4;
template <int W>
using RotorPack = Pack<rotors_in_pack<W>>;

/// Call a function for each pack of W rotors. Most vehicles fit in one pack, for which all offsets
/// in the tables are constants.
template <int W, class Work>
QUADCORE_LAW void for_each_pack(std::size_t rotors, const Work& work) {
  if (__builtin_expect(rotors - 1 < W, 1)) {
    work(std::size_t{0});
  } else {
    for (std::size_t i = 0; i < rotors; i += W) work(i);
  }
}

/// Return a vector of each lane from three rows of a table.
template <class T>
QUADCORE_LAW Vec3<T> load3(const double* row) {
  return {load<T>(row), load<T>(row + widest_lanes), load<T>(row + 2 * widest_lanes)};
}
template <class T>
QUADCORE_LAW void store3(double* row, const Vec3<T>& a) {
  store(row, a.x);
  store(row + widest_lanes, a.y);
  store(row + 2 * widest_lanes, a.z);
}

}  // namespace quadcore::laws
