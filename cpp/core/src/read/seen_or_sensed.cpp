#include "quadcore/seen_or_sensed.hpp"

#include <algorithm>
#include <set>

namespace quadcore {
namespace {

/// Elements that others extend. Within any other element everything counts.
const std::set<std::string> open_elements = {"robot",        "robot/link", "robot/joint",
                                             "robot/gazebo", "sdf",        "sdf/world"};

/// Known, felt, and not modelled: to leave them out would be to fly another vehicle.
const std::set<std::pair<std::string, std::string>> felt_elements = {{"robot/joint", "mimic"}};

const char* const camera = "pictures";
const char* const range = "distances";
const char* const inertial = "rates and accelerations";
const char* const position = "position and velocity";
const char* const joints = "joint angles and rates";
const char* const field = "the magnetic field";
const char* const pressure = "the air pressure";
const char* const contact = "forces and contacts, as they are";
const char* const connection = "connects topics";

}  // namespace

const std::vector<Unfelt>& everything_unfelt() {
  static const std::vector<Unfelt> table = {
      {"transmission", "robot", "for ros_control, which does not run here"},
      {"ros2_control", "robot", "for ros2_control, which does not run here"},
      {"properties", "robot", "numbers for gym-pybullet-drones; Gazebo passes over them, too"},
      {"sensor", "robot", "a sensor"},
      {"sensor", "robot/link", "a sensor"},
      {"pose", "robot/link",
       "of SDF; joints place links in a URDF, and Gazebo passes over it, too"},
      {"max_contacts", "robot/collision", "of SDF; Gazebo passes over it in a URDF, too"},
      {"provideFeedback", "robot/gazebo", "what a joint's sensor is told"},
      {"sensor", "robot/gazebo", "a sensor"},
      {"laserRetro", "robot/gazebo", "how bright a laser finds it"},
      {"self_collide", "robot/gazebo",
       "links of one vehicle do not collide; of no effect in Gazebo, either"},
      {"gui", "sdf/world", "the window"},
      {"scene", "sdf/world", "sky, fog and shadows"},
      {"light", "sdf/world", "light"},
      {"audio", "sdf/world", "sound"},
      {"road", "sdf/world", "a picture on the ground"},
      {"actor", "sdf/world", "a figure without body"},
      {"contact_surface_layer", "sdf/constraints", "of no effect in Gazebo, either"},
      {"min_step_size", "sdf/solver", "of solvers that choose their step"},

      {"libgazebo_ros_camera.so", "", camera},
      {"libgazebo_ros_depth_camera.so", "", camera},
      {"libgazebo_ros_multicamera.so", "", camera},
      {"libgazebo_ros_openni_kinect.so", "", camera},
      {"libgazebo_ros_prosilica.so", "", camera},
      {"libgazebo_ros_triggered_camera.so", "", camera},
      {"libgazebo_ros_triggered_multicamera.so", "", camera},
      {"libgazebo_ros_thermal_camera.so", "", camera},
      {"libgazebo_ros_zoom_camera.so", "", camera},
      {"libgazebo_ros_video.so", "", camera},
      {"librealsense_gazebo_plugin.so", "", camera},
      {"librotors_gazebo_noisydepth_plugin.so", "", camera},
      {"libgazebo_ros_laser.so", "", range},
      {"libgazebo_ros_gpu_laser.so", "", range},
      {"libgazebo_ros_block_laser.so", "", range},
      {"libgazebo_ros_ray_sensor.so", "", range},
      {"libgazebo_ros_range.so", "", range},
      {"libgazebo_ros_velodyne_laser.so", "", range},
      {"libgazebo_ros_velodyne_gpu_laser.so", "", range},
      {"libhector_gazebo_ros_sonar.so", "", range},
      {"libgazebo_lidar_plugin.so", "", range},
      {"libgazebo_sonar_plugin.so", "", range},
      {"librotors_gazebo_octomap_plugin.so", "", "a map of obstacles"},
      {"libgazebo_opticalflow_plugin.so", "", "the flow of pictures"},
      {"libgazebo_opticalFlow_plugin.so", "", "the flow of pictures"},
      {"libgazebo_ros_imu.so", "", inertial},
      {"libgazebo_ros_imu_sensor.so", "", inertial},
      {"libhector_gazebo_ros_imu.so", "", inertial},
      {"libgazebo_imu_plugin.so", "", inertial},
      {"libgazebo_ros_p3d.so", "", position},
      {"libgazebo_ros_gps_sensor.so", "", position},
      {"libhector_gazebo_ros_gps.so", "", position},
      {"libgazebo_gps_plugin.so", "", position},
      {"libgazebo_groundtruth_plugin.so", "", position},
      {"libgazebo_vision_plugin.so", "", position},
      {"libgazebo_ros_joint_state_publisher.so", "", joints},
      {"libgazebo_multirotor_base_plugin.so", "", joints},
      {"libhector_gazebo_ros_magnetic.so", "", field},
      {"libgazebo_magnetometer_plugin.so", "", field},
      {"libhector_gazebo_ros_baro.so", "", pressure},
      {"libgazebo_barometer_plugin.so", "", pressure},
      {"libgazebo_ros_bumper.so", "", contact},
      {"libgazebo_ros_f3d.so", "", contact},
      {"libgazebo_ros_ft_sensor.so", "", contact},
      {"librotors_gazebo_bag_plugin.so", "", "writes a bag"},
      {"libgazebo_ros_state.so", "", connection},
      {"libgazebo_ros_init.so", "", connection},
      {"librotors_gazebo_ros_interface_plugin.so", "", connection},
  };
  return table;
}

Verdict verdict_on_element(const std::string& parent, const std::string& element) {
  const std::vector<Unfelt>& table = everything_unfelt();
  const bool unfelt = std::any_of(table.begin(), table.end(), [&](const Unfelt& row) {
    return !row.parent.empty() && row.parent == parent && row.name == element;
  });
  if (unfelt) return Verdict::unfelt;
  const bool open = open_elements.count(parent) && !felt_elements.count({parent, element});
  return open ? Verdict::foreign : Verdict::felt;
}

Verdict verdict_on_module(const std::string& filename) {
  const std::vector<Unfelt>& table = everything_unfelt();
  const bool unfelt = std::any_of(table.begin(), table.end(), [&](const Unfelt& row) {
    return row.parent.empty() && row.name == filename;
  });
  return unfelt ? Verdict::unfelt : Verdict::foreign;
}

Verdict verdict_on_text(const std::string& parent) {
  // Deeper down it may be what is left of an element.
  return parent == "robot" ? Verdict::unfelt : Verdict::felt;
}

}  // namespace quadcore
