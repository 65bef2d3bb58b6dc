#pragma once

#include <ros/connection_manager.h>
#include <ros/transport/transport_tcp.h>

namespace quadcore::node {

/// Makes every connection of a subscriber to this node send at once. Otherwise, a message can wait
/// 40 ms for the acknowledgement of the previous one, which is too slow in lockstep. In roscpp,
/// only subscribers can request this. This function sets the option of the listening socket, and
/// Linux copies it to each accepted connection. Call it before the first topic is advertised.
inline void send_without_delay() {
  ros::ConnectionManager::instance()->getTCPServerTransport()->setNoDelay(true);
}

}  // namespace quadcore::node
