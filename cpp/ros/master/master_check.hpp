#pragma once

namespace quadcore::node {

/// Throws InputError if ROS_MASTER_URI is no address, over which roscpp would abort. Before
/// ros::init().
void check_master_uri();
/// Throws InputError unless a master answers. Without this check a node without one hangs in its
/// first advertise(). After ros::init().
void check_master();

}  // namespace quadcore::node
