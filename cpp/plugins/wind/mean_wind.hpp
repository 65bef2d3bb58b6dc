#pragma once

#include <algorithm>
#include <vector>

#include "quadcore/plugin/elementary.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/plugin/spatial.hpp"
#include "quadcore/plugin/tags.hpp"

namespace quadcore::wind {

/// Growth of the mean wind with height.
class Shear {
 public:
  explicit Shear(const Parameters& p)
      : law_(p.choice("shear") == "none"    ? Law::none
             : p.choice("shear") == "power" ? Law::power
                                            : Law::logarithmic),
        reference_(p.number("referenceHeight")),
        exponent_(p.number("exponent")),
        roughness_(p.number("roughness")) {
    if (law_ != Law::logarithmic) return;
    if (roughness_ >= reference_) {
      throw InputError("<roughness> is not below <referenceHeight>. Use a smaller value.");
    }
    scale_ = 1 / elementary::log(reference_ / roughness_);
  }

  bool acts() const { return law_ != Law::none; }
  /// Return the factor on the wind at the reference height, for a height above the ground [m].
  double factor(double height) const {
    if (law_ == Law::none) return 1;
    if (law_ == Law::power) {
      return height > 0 ? elementary::exp(exponent_ * elementary::log(height / reference_)) : 0;
    }
    return height > roughness_ ? scale_ * elementary::log(height / roughness_) : 0;
  }

 private:
  enum class Law { none, power, logarithmic } law_;
  double reference_, exponent_, roughness_, scale_ = 0;
};

/// A gust with v = V/2 (1 - cos(2 pi (t - begin)/duration)) for its duration.
struct Gust {
  Vector3d V_W;            ///< maximum velocity [m/s]
  double begin, duration;  ///< s

  void blow(double time, Vector3d& v_WA_W) const {
    const double t = time - begin;
    if (t <= 0 || t >= duration) return;
    v_WA_W += (1 - elementary::cos(6.283185307179586 * t / duration)) / 2 * V_W;
  }

  /// Number of values of one gust in the tag.
  static constexpr std::size_t numbers = 5;
  static std::vector<Gust> all(const Parameters& p) {
    const std::vector<double>& n = p.numbers("gusts");
    if (n.size() % numbers != 0) {
      throw InputError("<gusts> has " + std::to_string(n.size()) +
                       " numbers. Write five for each gust: x y z start duration.");
    }
    std::vector<Gust> gusts;
    for (std::size_t i = 0; i < n.size(); i += numbers) {
      const Gust gust{{n[i], n[i + 1], n[i + 2]}, n[i + 3], n[i + 4]};
      if (gust.begin < 0 || gust.duration <= 0) {
        throw InputError("gust " + std::to_string(i / numbers + 1) +
                         " of <gusts> starts before the flight or has no duration. Use a start >= "
                         "0 and a duration > 0.");
      }
      gusts.push_back(gust);
    }
    return gusts;
  }
};

}  // namespace quadcore::wind
