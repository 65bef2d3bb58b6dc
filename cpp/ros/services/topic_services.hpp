#pragma once

#include <ros/ros.h>

#include <string>
#include <vector>

#include "flight_thread.hpp"

namespace quadcore::node {

/// Offers each topic that plugins read and no plugin publishes as a service of the same name, in
/// the type of its kind. A service returns when the message is ready for the next step.
/// \param but  topics to skip
std::vector<ros::ServiceServer> offer_topics(ros::NodeHandle& nh, const Topics& topics,
                                             const std::vector<std::string>& but,
                                             FlightThread& flight);

}  // namespace quadcore::node
