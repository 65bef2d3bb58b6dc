#pragma once

#include <dynamic_reconfigure/Config.h>
#include <dynamic_reconfigure/Reconfigure.h>
#include <ros/ros.h>

#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace quadcore::node {

/// A value that may change while the node runs.
struct Adjustable {
  std::string name, meaning;
  bool is_flag = false;
  double min = 0, max = 1;  ///< range of the slider
  std::function<double()> get;
  std::function<void(double)> set;  ///< throws InputError if the value is not valid
};

/// Offers values to rqt_reconfigure by the protocol of dynamic_reconfigure. The server class of
/// that package needs a list of names when it is compiled, but each controller has other gains.
class Reconfigure {
 public:
  explicit Reconfigure(std::vector<Adjustable> values);
  /// Publishes the values if they have changed. Call it periodically.
  void update();
  /// Returns the resolved name of the service.
  std::string service() const { return service_.getService(); }

 private:
  using Config = dynamic_reconfigure::Config;

  bool set(dynamic_reconfigure::ReconfigureRequest& request,
           dynamic_reconfigure::ReconfigureResponse& response);
  void set(const std::string& name, bool is_flag, double value) const;
  Config collect(const std::function<double(const Adjustable&)>& value) const;
  void publish(const Config& config);

  const std::vector<Adjustable> values_;
  std::mutex mutex_;
  Config last_;  ///< published
  ros::Publisher description_publisher_, update_publisher_;
  ros::ServiceServer service_;
};

}  // namespace quadcore::node
