#include "master_watch.hpp"

#include <ros/connection_manager.h>
#include <ros/master.h>
#include <ros/message_traits.h>
#include <ros/network.h>
#include <ros/publication.h>
#include <ros/this_node.h>
#include <ros/topic_manager.h>
#include <ros/xmlrpc_manager.h>
#include <std_msgs/Float64MultiArray.h>

namespace quadcore::node {
namespace {

using XmlRpc::XmlRpcValue;

/// Calls the master's or a node's API, every argument a string. Returns whether it answered with
/// success.
bool call_master(const std::string& method, const std::vector<std::string>& arguments,
                 XmlRpcValue& result) {
  // `rosnode kill` makes roscpp shut down, and unregister, in a thread of its own.
  if (ros::isShuttingDown()) return false;
  XmlRpcValue request, response;
  int i = 0;
  for (const std::string& argument : arguments) request[i++] = argument;
  return ros::master::execute(method, request, response, result, false);
}

/// Tells this node's own subscriber who publishes a topic, as the master does for those who
/// register later.
void announce_publishers(const std::string& topic, const XmlRpcValue& publishers) {
  std::string host;
  std::uint32_t port = 0;
  const std::string uri = ros::XMLRPCManager::instance()->getServerURI();
  if (!ros::network::splitURI(uri, host, port)) return;
  XmlRpc::XmlRpcClient* const client =
      ros::XMLRPCManager::instance()->getXMLRPCClient(host, static_cast<int>(port), "/");
  XmlRpcValue request, response;
  request[0] = "/master";
  request[1] = topic;
  request[2] = publishers;
  client->execute("publisherUpdate", request, response);
  ros::XMLRPCManager::instance()->releaseXMLRPCClient(client);
}

}  // namespace

MasterWatch::MasterWatch(std::vector<std::string> services)
    : services_(std::move(services)),
      service_uri_("rosrpc://" + ros::network::getHost() + ":" +
                   std::to_string(ros::ConnectionManager::instance()->getTCPPort())) {
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
    look();
    lock.lock();
  }
}

void MasterWatch::look() {
  XmlRpcValue result;
  const std::string& name = ros::this_node::getName();
  if (!ros::master::check()) {
    if (!gone_) ROS_WARN("the ROS master is gone; flying on with those who are connected");
    gone_ = true;
  } else if (!call_master("lookupNode", {name, name}, result)) {
    if (ros::isShuttingDown()) return;
    register_again();
    ROS_WARN("there is a new ROS master; registered again");
    gone_ = false;
  } else if (gone_) {
    ROS_INFO("the ROS master is back");
    gone_ = false;
  }
}

void MasterWatch::register_again() const {
  const std::string& name = ros::this_node::getName();
  const std::string uri = ros::XMLRPCManager::instance()->getServerURI();
  const ros::TopicManagerPtr topics = ros::TopicManager::instance();
  XmlRpcValue result;
  ros::V_string names;
  topics->getAdvertisedTopics(names);
  for (const std::string& topic : names) {
    const ros::PublicationPtr publication = topics->lookupPublication(topic);
    if (!publication) continue;
    call_master("registerPublisher", {name, topic, publication->getDataType(), uri}, result);
  }
  names.clear();
  topics->getSubscribedTopics(names);
  for (const std::string& topic : names) {
    // Two at most: that of the commands and, with use_sim_time, the clock, registered above.
    const std::string type = topics->lookupPublication(topic)
                                 ? "*"
                                 : ros::message_traits::datatype<std_msgs::Float64MultiArray>();
    if (call_master("registerSubscriber", {name, topic, type, uri}, result)) {
      announce_publishers(topic, result);
    }
  }
  for (const std::string& service : services_) {
    call_master("registerService", {name, service, service_uri_, uri}, result);
  }
}

}  // namespace quadcore::node
