#pragma once

namespace quadcore::node {

/// Throws InputError if ROS_MASTER_URI is not an address, for which roscpp would abort. Call before
/// ros::init().
void check_master_uri();
/// Throws InputError if no master answers. Without this check, the node would hang in its first
/// advertise(). Call after ros::init().
void check_master();

}  // namespace quadcore::node
