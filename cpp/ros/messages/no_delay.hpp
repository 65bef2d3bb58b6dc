#pragma once

#include <ros/connection_manager.h>
#include <ros/transport/transport_tcp.h>

namespace quadcore::node {

/// Makes every connection of a subscriber to this node send at once. A subscriber may ask roscpp
/// for that, but few do, and then a message can wait 40 ms for the acknowledgement of the one
/// before: fatal in lockstep. roscpp offers the publisher no way to choose, so the socket that
/// listens is set, from which Linux gives the choice to each that it accepts. Call before the first
/// topic is advertised.
inline void send_without_delay() {
  ros::ConnectionManager::instance()->getTCPServerTransport()->setNoDelay(true);
}

}  // namespace quadcore::node
