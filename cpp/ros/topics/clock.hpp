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

#include "clock_publisher.hpp"
#include "flight_thread.hpp"

namespace quadcore::node {

/// Role of a node in the shared clock.
enum class ClockRole {
  automatic,  ///< leads, unless another node already leads
  lead,
  follow
};

/// The parameter that makes nodes use /clock.
constexpr char use_sim_time[] = "/use_sim_time";

/// Takes this node's role in the shared clock. The leader publishes /clock and sets /use_sim_time
/// unless it is set; the others make their steps by it. If several nodes start at once, the first
/// registered one leads.
/// \param rate  messages of a leader per second of simulation time; 0 = after each step
/// \return publisher of /clock; empty if this node follows
/// Throws InputError if this node must lead, but another node already leads.
ClockPublisher take_part_in_clock(ros::NodeHandle& nh, ClockRole role, double rate);

/// Followers publish the time of the clock that they need for their next step, and the leader waits
/// for it. A time of zero requests the clock, which may be paused.
constexpr const char* followers_topic = "/clock_followers";
/// Maximum lead over that time [s of simulation].
constexpr double longest_lead = 0.02;

/// The leader's side: delays the flight for followers.
class ClockLeader {
 public:
  ClockLeader(ros::NodeHandle& nh, FlightThread& flight, const ClockPublisher& clock);
  /// Stops waiting for silent followers, and removes those that have ended. Call it periodically.
  void poll();
  /// Returns the namespaces of the present followers.
  std::vector<std::string> spaces() const;

 private:
  struct Follower {
    double needs = 0;  ///< time of the clock that it needs [s]
    std::chrono::steady_clock::time_point heard;
  };
  void take(const std_msgs::Header& needs);
  void hold();

  FlightThread& flight_;
  ClockPublisher clock_;
  mutable std::mutex mutex_;
  std::map<std::string, Follower> followers_;
  double slowest_ =
      std::numeric_limits<double>::infinity();  ///< minimum of the times that they need [s]
  ros::Subscriber subscriber_;
};

/// The follower's side: passes the clock to the flight, and reports its progress to the leader.
class ClockFollower {
 public:
  /// \param dt  step of the flight [s]
  ClockFollower(ros::NodeHandle& nh, double dt);
  void follow(FlightThread& flight);
  /// Call after a step, in the flight's thread.
  void reached(double time);
  /// Call it periodically; otherwise the leader treats this node as ended.
  void report_progress(const FlightReport& report);

 private:
  void report_progress(const ros::Time& needs);
  void subscribe();

  ros::NodeHandle& nh_;
  const double dt_;
  FlightThread* flight_ = nullptr;
  double reported_ = -1;
  std::chrono::steady_clock::time_point subscribed_;
  ros::Publisher publisher_;
  ros::Subscriber subscriber_;
};

}  // namespace quadcore::node
