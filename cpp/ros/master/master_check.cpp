#include "master_check.hpp"

#include <ros/master.h>
#include <ros/network.h>

#include <cstdlib>
#include <future>
#include <thread>

#include "quadcore/plugin/error.hpp"

namespace quadcore::node {

void check_master_uri() {
  // The default of rospy and the ROS tools.
  setenv("ROS_MASTER_URI", "http://localhost:11311", 0);
  const std::string uri = std::getenv("ROS_MASTER_URI");
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(uri, host, port)) {
    throw InputError(
        "ROS_MASTER_URI: '" + uri +
        "' is not an address. Write http://HOST:PORT, such as http://localhost:11311.");
  }
}

void check_master() {
  // In a thread, because roscpp waits without limit for an unresponsive master.
  std::packaged_task<bool()> check(ros::master::check);
  std::future<bool> answer = check.get_future();
  std::thread(std::move(check)).detach();
  const bool in_time = answer.wait_for(std::chrono::seconds(5)) == std::future_status::ready;
  if (in_time && answer.get()) return;
  throw InputError((in_time ? "no ROS master at " : "no answer within 5 s from a ROS master at ") +
                   ros::master::getURI() +
                   ". Start roscore, use roslaunch, or correct ROS_MASTER_URI.");
}

}  // namespace quadcore::node
