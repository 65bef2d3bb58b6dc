#pragma once

#include <ros/ros.h>

#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace quadcore::node {

/// Looks once a second whether the ROS master still knows this node. One that was restarted does
/// not, and roscpp leaves it at that; here topics, services and parameters are registered again, so
/// that whoever starts afterwards finds them. Connections that stand go on without the master.
class MasterWatch {
 public:
  using Parameters = std::map<std::string, XmlRpc::XmlRpcValue>;

  /// \param services  names to register again; topics are known to roscpp
  /// \param parameters  to set again where a new master lacks them
  /// \param while_known  called after each look at a master that knows this node
  MasterWatch(std::vector<std::string> services, Parameters parameters,
              std::function<void()> while_known);
  ~MasterWatch();
  MasterWatch(const MasterWatch&) = delete;
  MasterWatch& operator=(const MasterWatch&) = delete;
  /// Looks no more. To be called before ros::shutdown(), after which the master does not know this
  /// node either.
  void end();

 private:
  void watch();
  void look();
  void register_again() const;

  std::vector<std::string> services_;
  const std::string service_uri_;
  const Parameters parameters_;
  const std::function<void()> while_known_;
  bool gone_ = false;
  int looks_to_register_again_ = 0;
  std::mutex mutex_;
  std::condition_variable ending_changed_;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace quadcore::node
