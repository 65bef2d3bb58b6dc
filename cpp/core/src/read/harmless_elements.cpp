#include "quadcore/harmless_elements.hpp"

#include <algorithm>
#include <set>

namespace quadcore {
namespace {

/// Elements of a model that other programs extend. Inside any other element, every child matters.
const std::set<std::string> open_elements = {"robot", "robot/link", "robot/joint", "robot/gazebo"};

/// Known elements that change the motion but are not modelled. Skipping them would simulate another
/// vehicle.
const std::set<std::pair<std::string, std::string>> physical_elements = {
    {"robot/joint", "mimic"}, {"sdf/world", "population"}};

/// Whether an element is part of a world, in which Gazebo ignores what it does not know.
bool is_in_world(const std::string& parent) { return parent.rfind("sdf", 0) == 0; }

const char* const camera = "images";
const char* const range = "distances";
const char* const inertial = "rates and accelerations";
const char* const position = "position and velocity";
const char* const joints = "joint angles and rates";
const char* const field = "magnetic field";
const char* const pressure = "air pressure";
const char* const contact = "forces and contacts";
const char* const score = "score of a task";
const char* const connection = "connection of topics";
const char* const picture = "appearance only";
const char* const successor = "for Gazebo's successor; Gazebo classic ignores it";

}  // namespace

const std::vector<HarmlessElement>& list_harmless_elements() {
  static const std::vector<HarmlessElement> table = {
      {"transmission", "robot", "for ros_control, which is not supported"},
      {"ros2_control", "robot", "for ros2_control, which is not supported"},
      {"properties", "robot", "parameters for gym-pybullet-drones; Gazebo also ignores them"},
      {"sensor", "robot", "sensor"},
      {"sensor", "robot/link", "sensor"},
      {"pose", "robot/link", "SDF only: joints place links in a URDF; Gazebo also ignores it"},
      {"max_contacts", "robot/collision", "SDF only; Gazebo also ignores it in a URDF"},
      {"provideFeedback", "robot/gazebo", "input of a joint's sensor"},
      {"sensor", "robot/gazebo", "sensor"},
      {"laserRetro", "robot/gazebo", "reflectivity for laser sensors"},
      {"self_collide", "robot/gazebo",
       "links of one vehicle do not collide; also without effect in Gazebo"},
      {"gui", "sdf/world", "graphical user interface"},
      {"scene", "sdf/world", "sky, fog and shadows"},
      {"light", "sdf/world", "light"},
      {"audio", "sdf/world", "sound"},
      {"road", "sdf/world", "texture on the ground"},
      {"actor", "sdf/world", "animated figure without collisions"},
      {"contact_surface_layer", "sdf/constraints", "also without effect in Gazebo"},
      {"min_step_size", "sdf/solver", "for solvers with a variable step"},

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
      {"librotors_gazebo_octomap_plugin.so", "", "map of obstacles"},
      {"libgazebo_opticalflow_plugin.so", "", "optical flow"},
      {"libgazebo_opticalFlow_plugin.so", "", "optical flow"},
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
      {"librotors_gazebo_bag_plugin.so", "", "recording of a bag file"},
      {"libscan_dock_scoring_plugin.so", "", score},
      {"libnavigation_scoring_plugin.so", "", score},
      {"libstationkeeping_scoring_plugin.so", "", score},
      {"libwayfinding_scoring_plugin.so", "", score},
      {"libperception_scoring_plugin.so", "", score},
      {"libContainPlugin.so", "", "whether a model is inside a region"},
      {"libSimEventsPlugin.so", "", "events of the simulation"},
      {"libusv_gazebo_wind_plugin.so", "", "wind on the boats that it names"},
      {"libWavefieldModelPlugin.so", "", "waves for boats"},
      {"libmodel_visuals.so", "", picture},
      {"libprojector_plugin.so", "", picture},
      {"libhello_world.so", "", "message on the console"},
      {"libgazebo_ros_power_monitor.so", "", "state of a battery"},
      {"gz-sim-physics-system", "", successor},
      {"gz-sim-user-commands-system", "", successor},
      {"gz-sim-scene-broadcaster-system", "", successor},
      {"gz-sim-sensors-system", "", successor},
      {"gz-sim-imu-system", "", successor},
      {"libgazebo_ros.so", "", connection},
      {"libgazebo_ros_api_plugin.so", "", connection},
      {"libgazebo_ros_state.so", "", connection},
      {"libgazebo_ros_init.so", "", connection},
      {"librotors_gazebo_ros_interface_plugin.so", "", connection},
  };
  return table;
}

Handling decide_on_element(const std::string& parent, const std::string& element, bool is_similar) {
  const std::vector<HarmlessElement>& table = list_harmless_elements();
  const bool is_harmless = std::any_of(table.begin(), table.end(), [&](const HarmlessElement& row) {
    return !row.parent.empty() && row.parent == parent && row.name == element;
  });
  if (is_harmless) return Handling::skip;
  const bool is_physical = physical_elements.count({parent, element});
  if (is_in_world(parent)) {
    return is_physical || is_similar ? Handling::reject_unless_ignored : Handling::skip;
  }
  const bool open = open_elements.count(parent) && !is_physical;
  return open ? Handling::reject_unless_ignored : Handling::reject;
}

Handling decide_on_module(const std::string& filename) {
  const std::vector<HarmlessElement>& table = list_harmless_elements();
  const bool is_harmless = std::any_of(table.begin(), table.end(), [&](const HarmlessElement& row) {
    return row.parent.empty() && row.name == filename;
  });
  return is_harmless ? Handling::skip : Handling::reject_unless_ignored;
}

bool moves_air(const std::string& filename) {
  return filename == "libgazebo_wind_plugin.so" || filename == "libWindPlugin.so";
}

Handling decide_on_text(const std::string& parent) {
  // Text in deeper elements of a model may be the remains of a damaged element.
  return parent == "robot" || is_in_world(parent) ? Handling::skip : Handling::reject;
}

Handling decide_on_excess(const std::string& parent) {
  return is_in_world(parent) ? Handling::skip : Handling::reject;
}

}  // namespace quadcore
