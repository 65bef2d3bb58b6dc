#pragma once

#include <ros/master.h>
#include <ros/this_node.h>
#include <ros/xmlrpc_manager.h>

#include <initializer_list>
#include <string>

/// \file
/// Calls of the ROS master's and of nodes' XML-RPC interfaces that roscpp has no names for.

namespace quadcore::node {

/// Calls the master, with this node's name before the arguments. Returns whether it answered with
/// success; waits for no master that is gone.
bool call_master(const std::string& method, std::initializer_list<XmlRpc::XmlRpcValue> arguments,
                 XmlRpc::XmlRpcValue& result);
/// Calls the node at `uri`, with this node's name before the arguments. Returns whether it
/// answered; `result` is what it said.
bool call_node(const std::string& uri, const std::string& method,
               std::initializer_list<XmlRpc::XmlRpcValue> arguments, XmlRpc::XmlRpcValue& result);
/// The first living node that has published a topic for longer than this one, by the order in which
/// the master lists them; "" = none.
std::string earlier_publisher(const std::string& topic);

}  // namespace quadcore::node
