#include "master_api.hpp"

#include <ros/init.h>
#include <ros/network.h>

namespace quadcore::node {
namespace {

using XmlRpc::XmlRpcValue;

XmlRpcValue make_list(const XmlRpcValue& first, std::initializer_list<XmlRpcValue> others) {
  XmlRpcValue all;
  all[0] = first;
  int i = 1;
  for (const XmlRpcValue& other : others) all[i++] = other;
  return all;
}

bool is_alive(const std::string& node) {
  XmlRpcValue uri, pid;
  return call_master("lookupNode", {node}, uri) &&
         call_node(static_cast<std::string>(uri), "getPid", {}, pid);
}

}  // namespace

bool call_master(const std::string& method, std::initializer_list<XmlRpcValue> arguments,
                 XmlRpcValue& result) {
  // After `rosnode kill`, roscpp shuts down and unregisters in another thread.
  if (ros::isShuttingDown()) return false;
  XmlRpcValue response;
  return ros::master::execute(method, make_list(ros::this_node::getName(), arguments), response,
                              result, false);
}

bool call_node(const std::string& uri, const std::string& method,
               std::initializer_list<XmlRpcValue> arguments, XmlRpcValue& result) {
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(uri, host, port)) return false;
  XmlRpc::XmlRpcClient* const client =
      ros::XMLRPCManager::instance()->getXMLRPCClient(host, static_cast<int>(port), "/");
  XmlRpcValue response;
  const bool answered =
      client->execute(method.c_str(), make_list(ros::this_node::getName(), arguments), response);
  ros::XMLRPCManager::instance()->releaseXMLRPCClient(client);
  // A status, a message, and the result.
  if (!answered || response.getType() != XmlRpcValue::TypeArray || response.size() < 3)
    return false;
  result = response[2];
  return true;
}

std::string find_earlier_publisher(const std::string& topic) {
  XmlRpcValue state;
  if (!call_master("getSystemState", {}, state)) return "";
  XmlRpcValue& topics = state[0];
  for (int i = 0; i < topics.size(); ++i) {
    if (static_cast<std::string>(topics[i][0]) != topic) continue;
    XmlRpcValue& publishers = topics[i][1];
    for (int j = 0; j < publishers.size(); ++j) {
      const std::string node = publishers[j];
      if (node == ros::this_node::getName()) return "";
      if (is_alive(node)) return node;
    }
  }
  return "";
}

}  // namespace quadcore::node
