#pragma once

#include <ros/ros.h>

#include <string>
#include <vector>

#include "flight_thread.hpp"

namespace quadcore::node {

/// Offers each topic that plugins take and nobody in the simulation writes as a service of its
/// name, in the type of its kind. It answers once the message is there for the next step.
/// \param but  topics that somebody else takes
std::vector<ros::ServiceServer> offer_topics(ros::NodeHandle& nh, const Topics& topics,
                                             const std::vector<std::string>& but,
                                             FlightThread& flight);

}  // namespace quadcore::node
