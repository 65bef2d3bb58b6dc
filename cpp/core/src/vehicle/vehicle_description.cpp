#include "quadcore/plugin/vehicle_description.hpp"

#include <algorithm>

#include "quadcore/plugin/error.hpp"

namespace quadcore {

std::vector<std::size_t> VehicleDescription::commanded() const {
  std::vector<std::size_t> joints;
  for (std::size_t i = 0; i < rotors.size(); ++i) {
    if (rotors[i].place != not_driven) joints.push_back(i);
  }
  std::stable_sort(joints.begin(), joints.end(), [this](std::size_t i, std::size_t j) {
    return rotors[i].place < rotors[j].place;
  });
  return joints;
}

std::vector<std::size_t> VehicleDescription::driven() const {
  const std::vector<std::size_t> joints = commanded();
  bool is_known = !joints.empty();
  for (std::size_t k = 0; k < joints.size() && is_known; ++k) {
    const RotorDescription& rotor = rotors[joints[k]];
    is_known = rotor.place == static_cast<int>(k);
    if (k > 0 && rotors[joints[k - 1]].place == rotor.place) {
      throw InputError("rotors '" + rotors[joints[k - 1]].joint + "' and '" + rotor.joint +
                       "' follow the same number of the command. Drive them by one plugin.");
    }
  }
  if (is_known) return joints;
  throw InputError(
      "no plugin defines which rotor follows which number of the command. Add "
      "libmotorpid_plugin.so, or set each rotor's place in describe_rotors() of your motor "
      "plugin.");
}

}  // namespace quadcore
