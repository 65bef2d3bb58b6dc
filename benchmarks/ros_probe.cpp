// A roscpp subscriber that measures, for ros_latency.py:
//   ros_probe count SECONDS    reads odom: messages, lost ones, simulated seconds, elapsed seconds,
//                              and by how many us more than the least they follow their stamps:
//                              median, 99 %, longest
//   ros_probe answer SECONDS   the same, with a command for each message
//   ros_probe latency SAMPLES  time from a vel_cmd to the odometry that reflects it, us, one a line
//   ros_probe echo SECONDS     answers each message on odom by a command, and counts nothing
//   ros_probe ask SECONDS      without a simulator: sends odometry to an echo, waits for its
//   command,
//                              and sends the next: exchanges, elapsed seconds

#include <nav_msgs/Odometry.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <std_msgs/Float64MultiArray.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <random>
#include <string>
#include <thread>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;

class Counter {
 public:
  /// \param answers  whether each message is answered by a command, as a node in lockstep does
  void run(ros::NodeHandle& nh, double seconds, bool answers) {
    if (answers) {
      publisher_ = nh.advertise<std_msgs::Float64MultiArray>("quadrotor/vel_cmd", 1);
      command_.data = {hover, -hover, hover, -hover};
    }
    const ros::Subscriber subscriber =
        nh.subscribe("odom", 0, &Counter::take, this, ros::TransportHints().tcpNoDelay());
    while (count_ == 0) ros::spinOnce();
    count_ = lost_ = 0;
    late_.clear();
    begin_ = last_;
    start_ = Clock::now();
    const Clock::time_point end = start_ + std::chrono::duration_cast<Clock::duration>(
                                               std::chrono::duration<double>(seconds));
    while (Clock::now() < end)
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.01));
    const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
    std::sort(late_.begin(), late_.end());
    const auto share = [this](double part) {
      const auto place = static_cast<std::size_t>(part * static_cast<double>(late_.size() - 1));
      return 1e6 * (late_[place] - late_.front());
    };
    std::printf("%ld %ld %.6f %.6f %.1f %.1f %.1f\n", count_, lost_, (last_ - begin_).toSec(),
                elapsed, share(0.5), share(0.99), share(1));
  }

 private:
  void take(const nav_msgs::Odometry& message) {
    if (publisher_) publisher_.publish(command_);
    if (count_ > 0) lost_ += std::lround((message.header.stamp - last_).toSec() * 1000) - 1;
    last_ = message.header.stamp;
    ++count_;
    const double since_start = std::chrono::duration<double>(Clock::now() - start_).count();
    late_.push_back(since_start - (last_ - begin_).toSec());
  }

  static constexpr double hover = 471.2;  // rad/s

  ros::Publisher publisher_;
  std_msgs::Float64MultiArray command_;
  long count_ = 0;
  long lost_ = 0;
  ros::Time begin_, last_;
  Clock::time_point start_;
  std::vector<double>
      late_;  ///< time of arrival less that of the stamp, both from the start on [s]
};

class Latency {
 public:
  void run(ros::NodeHandle& nh, int samples) {
    const ros::Publisher publisher =
        nh.advertise<std_msgs::Float64MultiArray>("quadrotor/vel_cmd", 1);
    const ros::Subscriber subscriber =
        nh.subscribe("odom", 0, &Latency::take, this, ros::TransportHints().tcpNoDelay());
    ros::AsyncSpinner spinner(1);
    spinner.start();
    while (publisher.getNumSubscribers() == 0 || subscriber.getNumPublishers() == 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    std::mt19937 generator(1);
    std::uniform_real_distribution<double> pause(0.03, 0.05);
    std_msgs::Float64MultiArray command;
    command.data.assign(4, speed);
    for (int i = -10; i < samples; ++i) {  // the first ones set the rotors going
      std::this_thread::sleep_for(std::chrono::duration<double>(pause(generator)));
      for (double& value : command.data) value = -value;
      std::unique_lock<std::mutex> lock(mutex_);
      waiting_ = true;
      sent_ = Clock::now();
      publisher.publish(command);
      if (!seen_.wait_for(lock, std::chrono::seconds(1), [this] { return !waiting_; })) {
        std::fprintf(stderr, "a command had no effect within a second\n");
        std::exit(1);
      }
      if (i >= 0) std::printf("%.1f\n", latency_);
    }
  }

 private:
  /// All rotors turn the same way, and each command reverses them: the reaction of the motors kicks
  /// the frame's yaw rate within the very step that takes the command.
  void take(const nav_msgs::Odometry& message) {
    const Clock::time_point now = Clock::now();
    const double rate = message.twist.twist.angular.z;
    const double gain = rate - last_rate_;
    const std::lock_guard<std::mutex> lock(mutex_);
    if (waiting_ && std::abs(gain - last_gain_) > kick) {
      latency_ = std::chrono::duration<double, std::micro>(now - sent_).count();
      waiting_ = false;
      seen_.notify_one();
    }
    last_rate_ = rate;
    last_gain_ = gain;
  }

  static constexpr double speed = 300;  // rad/s
  static constexpr double kick = 0.02;  // rad/s in one step

  std::mutex mutex_;
  std::condition_variable seen_;
  bool waiting_ = false;
  Clock::time_point sent_;
  double latency_ = 0;
  double last_rate_ = 0;
  double last_gain_ = 0;
};

/// What an exchange costs in roscpp alone, with messages of the simulator's types and sizes: the
/// speed that no simulator in lockstep can exceed.
class BareExchange {
 public:
  void echo(ros::NodeHandle& nh, double seconds) {
    const ros::Publisher publisher =
        nh.advertise<std_msgs::Float64MultiArray>("quadrotor/vel_cmd", 1);
    std_msgs::Float64MultiArray command;
    command.data.assign(4, 0.0);
    const ros::Subscriber subscriber = nh.subscribe<nav_msgs::Odometry>(
        "odom", 1, [&](const nav_msgs::Odometry::ConstPtr&) { publisher.publish(command); },
        ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
    const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(seconds);
    while (ros::WallTime::now() < end)
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.01));
  }

  void ask(ros::NodeHandle& nh, double seconds) {
    const ros::Publisher publisher = nh.advertise<nav_msgs::Odometry>("odom", 1);
    long answers = 0;
    const ros::Subscriber subscriber = nh.subscribe<std_msgs::Float64MultiArray>(
        "quadrotor/vel_cmd", 1,
        [&answers](const std_msgs::Float64MultiArray::ConstPtr&) { ++answers; },
        ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
    while (publisher.getNumSubscribers() == 0 || subscriber.getNumPublishers() == 0)
      ros::WallDuration(0.01).sleep();
    nav_msgs::Odometry odometry;
    odometry.header.frame_id = "world";
    odometry.child_frame_id = "drone";
    const Clock::time_point start = Clock::now();
    double elapsed = 0;
    while (elapsed < seconds) {
      const long before = answers;
      publisher.publish(odometry);
      while (answers == before && elapsed < seconds) {
        ros::getGlobalCallbackQueue()->callOne(ros::WallDuration(0.1));
        elapsed = std::chrono::duration<double>(Clock::now() - start).count();
      }
    }
    std::printf("%ld %.6f\n", answers, elapsed);
  }
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const std::string mode = argv[1];
  ros::init(argc, argv, "probe_" + mode);
  ros::NodeHandle nh;
  if (mode == "count" || mode == "answer") {
    Counter().run(nh, std::atof(argv[2]), mode == "answer");
  } else if (mode == "echo") {
    BareExchange().echo(nh, std::atof(argv[2]));
  } else if (mode == "ask") {
    BareExchange().ask(nh, std::atof(argv[2]));
  } else {
    Latency().run(nh, std::atoi(argv[2]));
  }
  return 0;
}
