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

/// Checks once a second whether this node is registered with the ROS master. After a restart of the
/// master, roscpp does not register again. This class registers topics, services and parameters
/// again for nodes that start later. Existing connections continue without the master.
class MasterWatch {
 public:
  using Parameters = std::map<std::string, XmlRpc::XmlRpcValue>;

  /// \param services  names to register again; roscpp lists the topics
  /// \param parameters  to set again if a new master does not have them
  /// \param while_known  called after each successful check
  MasterWatch(std::vector<std::string> services, Parameters parameters,
              std::function<void()> while_known);
  ~MasterWatch();
  MasterWatch(const MasterWatch&) = delete;
  MasterWatch& operator=(const MasterWatch&) = delete;
  /// Ends the checks. Call before ros::shutdown(), which unregisters the node.
  void end();

 private:
  void watch();
  void poll();
  void register_again() const;

  std::vector<std::string> services_;
  const std::string service_uri_;
  const Parameters parameters_;
  const std::function<void()> while_known_;
  bool gone_ = false;
  int polls_to_register_again_ = 0;
  std::mutex mutex_;
  std::condition_variable ending_changed_;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace quadcore::node
