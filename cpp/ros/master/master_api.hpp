#pragma once

#include <ros/master.h>
#include <ros/this_node.h>
#include <ros/xmlrpc_manager.h>

#include <initializer_list>
#include <string>

/// \file
/// Calls of the XML-RPC interfaces of the ROS master and of nodes that roscpp does not provide.

namespace quadcore::node {

/// Calls the master, with this node's name as the first argument. Returns whether the call
/// succeeded; does not wait for a missing master.
bool call_master(const std::string& method, std::initializer_list<XmlRpc::XmlRpcValue> arguments,
                 XmlRpc::XmlRpcValue& result);
/// Calls the node at `uri`, with this node's name as the first argument. Returns whether it
/// answered, and its result.
bool call_node(const std::string& uri, const std::string& method,
               std::initializer_list<XmlRpc::XmlRpcValue> arguments, XmlRpc::XmlRpcValue& result);
/// Returns the first live node that registered as a publisher of a topic before this one; "" = no
/// such node.
std::string find_earlier_publisher(const std::string& topic);

}  // namespace quadcore::node
