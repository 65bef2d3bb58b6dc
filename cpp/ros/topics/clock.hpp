#pragma once

#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>
#include <std_msgs/Header.h>

#include <chrono>
#include <limits>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "flight_thread.hpp"
#include "kept_publisher.hpp"

namespace quadcore::node {

/// Whose clock a node goes by.
enum class ClockRole {
  automatic,  ///< leads, unless somebody leads already
  lead,
  follow
};

/// The parameter that makes nodes go by /clock.
constexpr char use_sim_time[] = "/use_sim_time";

/// Takes this node's part in the one clock that all have: whoever leads publishes /clock and says
/// so by /use_sim_time unless that is set, the others make their steps by it. If several start at
/// once, the one that the master knew first leads.
/// \return the publisher of /clock; empty if this node follows.
/// Throws InputError if another node leads though this one is to.
KeptPublisher<rosgraph_msgs::Clock> take_part_in_clock(ros::NodeHandle& nh, ClockRole role);

/// Followers tell the leader up to where they need the clock for their next step, so that it does
/// not run away from them; a time of zero asks for the clock, which may stand.
constexpr const char* followers_topic = "/clock_followers";
/// The leader is ahead of that by at most this [s of simulation].
constexpr double longest_lead = 0.02;

/// The leader's side: holds the flight back for those who follow.
class ClockLeader {
 public:
  ClockLeader(ros::NodeHandle& nh, FlightThread& flight,
              const KeptPublisher<rosgraph_msgs::Clock>& clock);
  /// Waits no longer for followers that are silent, and forgets those that have gone. To be called
  /// now and then.
  void look();
  /// Namespaces of the nodes that follow now.
  std::vector<std::string> spaces() const;

 private:
  struct Follower {
    double needs = 0;  ///< the clock to come to this [s]
    std::chrono::steady_clock::time_point heard;
  };
  void take(const std_msgs::Header& needs);
  void hold();

  FlightThread& flight_;
  KeptPublisher<rosgraph_msgs::Clock> clock_;
  mutable std::mutex mutex_;
  std::map<std::string, Follower> followers_;
  double slowest_ = std::numeric_limits<double>::infinity();  ///< of what they need [s]
  ros::Subscriber subscriber_;
};

/// The follower's side: hands the clock to the flight, and tells the leader how far that has come.
class ClockFollower {
 public:
  /// \param dt  length of the flight's steps [s]
  ClockFollower(ros::NodeHandle& nh, double dt);
  void follow(FlightThread& flight);
  /// A step has ended. From the flight's thread.
  void reached(double time);
  /// To be called now and then, or the leader takes this node for gone.
  void tell(const FlightReport& report);

 private:
  void tell(const ros::Time& needs);
  void subscribe();

  ros::NodeHandle& nh_;
  const double dt_;
  FlightThread* flight_ = nullptr;
  double told_ = -1;
  std::chrono::steady_clock::time_point subscribed_;
  ros::Publisher publisher_;
  ros::Subscriber subscriber_;
};

}  // namespace quadcore::node
