# For find_package(quadcore): the target quadcore::quadcore, in a workspace and without ROS.
if(NOT TARGET quadcore::quadcore)
  find_package(Eigen3 3.3 REQUIRED NO_MODULE)
  # Does not exist while the same run of catkin_make configures quadcore itself.
  include(${quadcore_DIR}/../../../lib/cmake/quadcore/quadcore.cmake OPTIONAL)
endif()
