#include "master_watch.hpp"

#include <ros/connection_manager.h>
#include <ros/network.h>

#include <set>

#include "master_api.hpp"

namespace quadcore::node {

using XmlRpc::XmlRpcValue;

namespace {

/// Each node polls once a second: after this many polls, all have registered with a new master.
constexpr int polls_until_all_are_back = 3;

/// Returns the publishers of a topic: those in a list, and those connected to the node at `uri`.
XmlRpcValue list_publishers(const std::string& uri, const std::string& topic, XmlRpcValue& listed) {
  std::set<std::string> all;
  for (int i = 0; i < listed.size(); ++i) all.insert(listed[i]);
  XmlRpcValue connections;
  if (!call_node(uri, "getBusInfo", {}, connections)) connections.setSize(0);
  // Each has: number, other node, direction, transport, topic, ...
  for (int i = 0; i < connections.size(); ++i) {
    XmlRpcValue& connection = connections[i];
    if (static_cast<std::string>(connection[2]) != "i") continue;
    if (static_cast<std::string>(connection[4]) == topic) all.insert(connection[1]);
  }
  XmlRpcValue publishers;
  publishers.setSize(0);
  for (const std::string& publisher : all) publishers[publishers.size()] = publisher;
  return publishers;
}

}  // namespace

MasterWatch::MasterWatch(std::vector<std::string> services, Parameters parameters,
                         std::function<void()> while_known)
    : services_(std::move(services)),
      service_uri_("rosrpc://" + ros::network::getHost() + ":" +
                   std::to_string(ros::ConnectionManager::instance()->getTCPPort())),
      parameters_(std::move(parameters)),
      while_known_(std::move(while_known)) {
  for (const char* own : {"/get_loggers", "/set_logger_level"}) {
    services_.push_back(ros::this_node::getName() + own);
  }
  thread_ = std::thread(&MasterWatch::watch, this);
}

MasterWatch::~MasterWatch() { end(); }

void MasterWatch::end() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ending_ = true;
  }
  ending_changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void MasterWatch::watch() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!ending_changed_.wait_for(lock, std::chrono::seconds(1), [this] { return ending_; })) {
    lock.unlock();
    poll();
    lock.lock();
  }
}

void MasterWatch::poll() {
  XmlRpcValue result;
  const std::string& name = ros::this_node::getName();
  if (!ros::master::check()) {
    if (!gone_) ROS_WARN("The ROS master is gone. The flight continues with the connected nodes.");
    gone_ = true;
  } else if (!call_master("lookupNode", {name}, result)) {
    if (ros::isShuttingDown()) return;
    register_again();
    ROS_WARN("There is a new ROS master. The node has registered again.");
    gone_ = false;
    polls_to_register_again_ = polls_until_all_are_back;
  } else {
    if (gone_) ROS_INFO("The ROS master is back.");
    gone_ = false;
    if (polls_to_register_again_ > 0) {
      --polls_to_register_again_;
      register_again();
    }
    while_known_();
  }
}

void MasterWatch::register_again() const {
  const std::string uri = ros::XMLRPCManager::instance()->getServerURI();
  XmlRpcValue result, topics;
  // Parameters first, because a node that starts next may read them at once.
  for (const auto& [key, value] : parameters_) {
    const bool answered = call_master("hasParam", {key}, result);
    if (answered && !static_cast<bool>(result)) call_master("setParam", {key, value}, result);
  }
  // The node's own interface lists its topics: pairs of name and type.
  if (!call_node(uri, "getPublications", {}, topics)) topics.setSize(0);
  for (int i = 0; i < topics.size(); ++i) {
    call_master("registerPublisher", {topics[i][0], topics[i][1], uri}, result);
  }
  if (!call_node(uri, "getSubscriptions", {}, topics)) topics.setSize(0);
  for (int i = 0; i < topics.size(); ++i) {
    XmlRpcValue publishers;
    if (!call_master("registerSubscriber", {topics[i][0], topics[i][1], uri}, publishers)) continue;
    // Like the master for later publishers. roscpp disconnects publishers that are not in the list,
    // and nodes register with a new master one by one.
    call_node(uri, "publisherUpdate",
              {topics[i][0], list_publishers(uri, topics[i][0], publishers)}, result);
  }
  for (const std::string& service : services_) {
    call_master("registerService", {service, service_uri_, uri}, result);
  }
}

}  // namespace quadcore::node
