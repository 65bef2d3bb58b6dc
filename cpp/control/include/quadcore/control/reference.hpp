#pragma once

#include <cstdint>
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

/// A reference as a pure function of time.
class ReferenceShape {
 public:
  ReferenceShape();
  virtual ~ReferenceShape() = default;
  /// Return a positive number that only this reference and its copies have. Its address may later
  /// be that of another reference.
  std::uint64_t serial() const { return serial_; }
  /// Return the reference with all derivatives; at jumps, those from the right. \param t  since the
  /// start [s]
  virtual Reference at(double t) const = 0;
  /// Return the time from which the reference is at rest [s].
  virtual double end() const { return std::numeric_limits<double>::infinity(); }

 private:
  std::uint64_t serial_;
};

/// Rows of time [s] and position [m], or of time, position and yaw [rad].
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A kind of reference that users can choose.
struct ReferenceInfo {
  std::string name;            ///< name of the reference
  std::string summary;         ///< one line
  bool takes_rows;             ///< whether it requires rows
  std::vector<TagSpec> table;  ///< parameters
  /// Creates one from checked values. Throws InputError for invalid rows.
  std::function<std::unique_ptr<ReferenceShape>(const Values&, const Rows&)> make;
};

/// Return all built-in references.
const std::vector<ReferenceInfo>& references();
/// Return a kind of reference by name. Throws InputError with the names of all.
const ReferenceInfo& reference_info(const std::string& name);
/// Complete values with those of a vehicle: `ground` defaults to the height of its frame when it
/// stands upright on the ground.
Values on_vehicle(const std::string& name, Values values, const Model& model);
/// Create a reference. Throws InputError for an unknown name, a value out of range or invalid rows.
std::unique_ptr<ReferenceShape> make_reference(const std::string& name, const Values& values,
                                               const Rows& rows = {});

}  // namespace control
}  // namespace quadcore
