#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "quadcore/control/settings.hpp"
#include "quadcore/plugin/messages.hpp"
#include "quadcore/plugin/model.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

using messages::Reference;

/// Where a vehicle is to be, at any time: a pure function.
class ReferenceShape {
 public:
  virtual ~ReferenceShape() = default;
  /// With all derivatives, from the right where there are two. \param t  since the start [s]
  virtual Reference at(double t) const = 0;
  /// From when on nothing moves any more [s].
  virtual double end() const { return std::numeric_limits<double>::infinity(); }
};

/// Rows of time [s] and position [m], or of time, position and yaw [rad].
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A kind of reference, as users choose it.
struct ReferenceInfo {
  std::string name;            ///< as users write it
  std::string summary;         ///< one line
  bool takes_rows;             ///< and cannot do without
  std::vector<TagSpec> table;  ///< its parameters
  /// Makes one of values that were checked. Throws InputError on rows that are none.
  std::function<std::unique_ptr<ReferenceShape>(const Values&, const Rows&)> make;
};

/// Every kind there is.
const std::vector<ReferenceInfo>& references();
/// Throws InputError with the names of those there are.
const ReferenceInfo& reference_info(const std::string& name);
/// Values, and what a vehicle says where they do not: `ground` is where its frame is when it rests
/// on what touches the ground first, upright.
Values on_vehicle(const std::string& name, Values values, const Model& model);
/// Throws InputError on an unknown name, a value out of range, or rows that are none.
std::unique_ptr<ReferenceShape> make_reference(const std::string& name, const Values& values,
                                               const Rows& rows = {});

}  // namespace control
}  // namespace quadcore
