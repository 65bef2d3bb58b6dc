#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "quadcore/control/allocation.hpp"
#include "quadcore/control/belief.hpp"
#include "quadcore/control/reference.hpp"

namespace quadcore QUADCORE_EXPORT {
/// Controllers: a law asks for thrust and torques that keep a vehicle on a reference, and an
/// allocation finds the rotors' speeds that exert them.
namespace control {

using messages::Odometry;

/// What a law is told.
struct Instant {
  double period;            ///< since the last call and until the next [s]
  bool begins;              ///< whether this is the first call
  const Odometry& now;      ///< linear velocity in W
  const Reference& wanted;  ///< where the vehicle is to be
  Demand exerted;           ///< by the rotors now, as is believed
  Vector3d h_F;             ///< angular momentum of the rotors now, as is believed [kg m^2/s]
  bool saturated;           ///< whether the last demand was not met
};

/// A control law down to thrust and torques. It is immutable; its memory is numbers of its caller,
/// all zero at the beginning.
class Law {
 public:
  virtual ~Law() = default;
  /// What the rotors are to exert until the next call.
  /// \param memory  LawInfo::memory_size numbers
  virtual Demand demand(const Instant& instant, double* memory) const = 0;
};

/// A law, as users choose it.
struct LawInfo {
  std::string name;            ///< as users write it
  std::string summary;         ///< one line
  std::vector<TagSpec> table;  ///< its own parameters
  std::size_t memory_size;     ///< numbers of memory that it needs
  Values defaults;             ///< of these and of Controller's, where they differ from the tables
  /// Makes it of values that were checked. Throws InputError if no gains come of them.
  std::function<std::unique_ptr<Law>(const Belief&, const Values&)> make;
};

/// A law whose class is made of a belief and its gains.
template <class L>
LawInfo law(const std::string& name, const std::string& summary, const Values& defaults = {}) {
  return {name,
          summary,
          table_of(L::settings()),
          L::memory_size,
          defaults,
          [](const Belief& belief, const Values& values) {
            typename L::Gains gains{};
            configure(gains, L::settings(), values);
            return std::make_unique<L>(belief, gains);
          }};
}

/// Every law there is.
const std::vector<LawInfo>& laws();
/// Throws InputError with the names of those there are.
const LawInfo& law_info(const std::string& name);

}  // namespace control
}  // namespace quadcore
