#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "quadcore/control/controller.hpp"
#include "quadcore/control/reference.hpp"
#include "quadcore/plugin/elementary.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

class FlatTable;

/// Points of a reference with the flat states that a controller uses. They are computed for several
/// calls at once, because processors compute several flat states as fast as one. The results are
/// bit-identical to those for single points.
class ReferencePreview {
 public:
  /// A point of the reference.
  struct Point {
    double time;                    ///< s
    Reference wanted;               ///< reference at this time
    elementary::SineCosine of_yaw;  ///< sine and cosine of its yaw
    /// Table that contains its flat state until the next points are computed; null if the
    /// controller uses none or it is undefined.
    const FlatTable* flat;
    std::size_t column;  ///< of the table

    /// Return the flat state; nothing if `flat` is null.
    std::optional<FlatState> flat_state() const;
  };
  /// Writes the times of the present call and of the next ones if the flight goes on [s].
  using ListTimes = std::function<void(double* times, std::size_t count)>;

  /// \param controller  copied as far as needed
  explicit ReferencePreview(const Controller& controller);
  ReferencePreview(ReferencePreview&&) noexcept;  ///< takes over the points that are computed
  ~ReferencePreview();

  /// Return the point at the time of the present call.
  const Point& at(double time, const ReferenceShape& reference, const ListTimes& list_times);

 private:
  void look_ahead(const ReferenceShape& reference, const ListTimes& list_times);
  const elementary::SineCosine& sincos(double yaw);

  std::unique_ptr<FlatTable> table_;  ///< null if the controller uses no flat state
  std::uint64_t reference_ = 0;       ///< ReferenceShape::serial() of the points; 0: no points
  std::vector<Point> points_;
  std::size_t present_ = 0;  ///< point of the last call
  /// The last yaw with its sine and cosine, because most references keep their yaw.
  double yaw_ = std::numeric_limits<double>::quiet_NaN();
  elementary::SineCosine of_yaw_{};
};

}  // namespace control
}  // namespace quadcore
