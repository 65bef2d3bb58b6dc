# The ROS 1 node, built by catkin's rules. The top-level CMakeLists.txt includes this file instead of
# adding a folder, because catkin uses the folder of the calling list file as the package's folder.

# Packages come after their dependencies, because a missing dependency ends the configuration.
set(ros_packages
  message_generation roscpp std_msgs std_srvs geometry_msgs sensor_msgs nav_msgs rosgraph_msgs
  diagnostic_msgs tf2_msgs trajectory_msgs visualization_msgs dynamic_reconfigure roslz4)

# The first python3 on PATH may not be the one of the ROS packages. catkin then ends the configuration,
# even with QUIET. Some packages load catkin, so this check comes first.
if(NOT PYTHON_EXECUTABLE)
  foreach(python python3 /usr/bin/python3)
    execute_process(COMMAND ${python} -c "import catkin_pkg, em, genmsg, sys; print(sys.executable)"
                    OUTPUT_VARIABLE found OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    if(found)
      set(PYTHON_EXECUTABLE ${found} CACHE FILEPATH "The Python of the ROS packages")
      break()
    endif()
  endforeach()
endif()
if(POLICY CMP0148)
  cmake_policy(SET CMP0148 OLD)  # catkin uses FindPythonInterp
endif()

# A catkin workspace needs the node. Checked before catkin is loaded, because catkin sets the second
# variable.
if(CATKIN_TOPLEVEL OR CATKIN_DEVEL_PREFIX OR QUADCORE_WITH_ROS STREQUAL "ON")
  set(ros_wanted ON)
else()
  set(ros_wanted OFF)
endif()

# need(WHAT DEBIAN_PACKAGE NOETIC_PACKAGE): records a missing package, and how to install it.
set(ros_missing "")
set(ros_to_install "")
macro(need what debian noetic)
  list(APPEND ros_missing "${what}")
  if(EXISTS /opt/ros/noetic)
    string(APPEND ros_to_install " ${noetic}")
  else()
    string(APPEND ros_to_install " ${debian}")
  endif()
endmacro()
if(NOT PYTHON_EXECUTABLE)
  need("a python3 with catkin_pkg, empy and genmsg" "catkin ros-message-generation"
       "ros-noetic-catkin ros-noetic-message-generation")
else()
  foreach(package ${ros_packages})
    find_package(${package} QUIET NO_MODULE)
    string(REPLACE _ - dashed ${package})
    if(package STREQUAL message_generation)
      set(debian ros-message-generation)
    elseif(package STREQUAL dynamic_reconfigure)
      set(debian libdynamic-reconfigure-config-init-mutex-dev)
    else()
      set(debian lib${dashed}-dev)
    endif()
    if(NOT ${package}_FOUND)
      need(${package} ${debian} ros-noetic-${dashed})
    endif()
  endforeach()
endif()
# Debian has separate packages for .msg files.
if(geometry_msgs_FOUND)
  include(${geometry_msgs_DIR}/geometry_msgs-msg-paths.cmake OPTIONAL)
  if(NOT EXISTS ${geometry_msgs_MSG_INCLUDE_DIRS}/Pose.msg)
    need("the .msg files of geometry_msgs" ros-geometry-msgs ros-noetic-geometry-msgs)
  endif()
endif()
if(PYTHON_EXECUTABLE)
  set(Python_EXECUTABLE ${PYTHON_EXECUTABLE})
  include(cpp/bindings/python.cmake)
  if(python_missing)
    need("${python_missing}" "python3-dev pybind11-dev" "python3-dev pybind11-dev")
  endif()
endif()
if(NOT BUILD_SHARED_LIBS)
  need("a shared core (BUILD_SHARED_LIBS)" "" "")
endif()

if(ros_missing)
  string(REPLACE ";" ", " ros_missing "${ros_missing}")
  set(remedy "not found: ${ros_missing}.\nInstall it, or source the setup.bash of ROS:\n"
             "  apt-get install${ros_to_install}\n")
  if(ros_wanted)
    message(FATAL_ERROR "quadcore's ROS node cannot be built; " ${remedy}
                        "To build quadcore without it, configure with -DQUADCORE_WITH_ROS=OFF.")
  elseif(roscpp_FOUND)
    message(WARNING "quadcore is built without its ROS node; " ${remedy})
  else()
    message(STATUS "quadcore: without the ROS node (there is no ROS 1)")
  endif()
  return()
endif()

find_package(catkin REQUIRED COMPONENTS ${ros_packages})

include(cpp/ros/foreign_messages.cmake)

# The Python package, including the services.
set(QUADCORE_PYTHONDIR ${PYTHON_INSTALL_DIR}/quadcore)
add_subdirectory(cpp/bindings)
set_target_properties(_core PROPERTIES
  LIBRARY_OUTPUT_DIRECTORY ${CATKIN_DEVEL_PREFIX}/${QUADCORE_PYTHONDIR})
catkin_python_setup()
add_message_files(FILES AttitudeThrust.msg RateThrust.msg)
add_service_files(FILES ApplyWrench.srv Publish.srv SetState.srv Step.srv)
generate_messages(DEPENDENCIES geometry_msgs std_msgs)
# catkin warns about exported headers in the build folder.
configure_file(${PROJECT_BINARY_DIR}/cpp/core/include/quadcore/plugin_interface.hpp
               ${CATKIN_DEVEL_PREFIX}/include/quadcore/plugin_interface.hpp COPYONLY)
catkin_package(
  INCLUDE_DIRS cpp/core/include cpp/control/include ${CATKIN_DEVEL_PREFIX}/include
  LIBRARIES quadcore
  CATKIN_DEPENDS diagnostic_msgs dynamic_reconfigure geometry_msgs message_runtime nav_msgs roscpp
                 rosgraph_msgs roslz4 sensor_msgs std_msgs std_srvs tf2_msgs trajectory_msgs visualization_msgs
  CFG_EXTRAS ${CMAKE_CURRENT_LIST_DIR}/quadcore-target.cmake)
export(TARGETS quadcore NAMESPACE quadcore::
       FILE ${CATKIN_DEVEL_PREFIX}/lib/cmake/quadcore/quadcore.cmake)

# As in the install space, the core and its plugins are together in lib.
get_property(plugins DIRECTORY cpp/plugins PROPERTY BUILDSYSTEM_TARGETS)
set_target_properties(quadcore ${plugins} PROPERTIES
  LIBRARY_OUTPUT_DIRECTORY ${CATKIN_DEVEL_PREFIX}/lib)
set(named_as_others ${plugins})
list(FILTER named_as_others INCLUDE REGEX "^rotors_")
set_target_properties(${named_as_others} PROPERTIES
  LIBRARY_OUTPUT_DIRECTORY ${CATKIN_DEVEL_PREFIX}/lib/quadcore)

# Settings to compile a file that includes messages.
function(quadcore_use_ros target scope)
  target_include_directories(${target} SYSTEM ${scope} ${catkin_INCLUDE_DIRS}
                             ${CATKIN_DEVEL_PREFIX}/include ${foreign_dir})
  target_compile_definitions(${target} ${scope} BOOST_BIND_GLOBAL_PLACEHOLDERS)
  add_dependencies(${target} ${catkin_EXPORTED_TARGETS} quadcore_generate_messages_cpp
                   foreign_messages)
endfunction()

# quadcore_add_ros_objects(NAME SOURCE...) makes a library of one folder of the nodes. As in the core,
# it links the libraries of lower layers.
function(quadcore_add_ros_objects name)
  add_library(${name} OBJECT ${ARGN})
  target_include_directories(${name} PUBLIC ${CMAKE_CURRENT_SOURCE_DIR})
  quadcore_use_ros(${name} PUBLIC)
  quadcore_precompile(${name} <ros/ros.h>)
endfunction()

# quadcore_add_ros_node(NAME SOURCE... [LIBRARIES FOLDER...]) makes a program from sources and folders.
function(quadcore_add_ros_node name)
  cmake_parse_arguments(PARSE_ARGV 1 given "" "" LIBRARIES)
  add_executable(${name} ${given_UNPARSED_ARGUMENTS})
  quadcore_use_ros(${name} PRIVATE)
  list(TRANSFORM given_LIBRARIES PREPEND quadcore_ros_)
  target_link_libraries(${name} PRIVATE ${given_LIBRARIES} ${catkin_LIBRARIES} Threads::Threads)
  set_target_properties(${name} PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY ${CATKIN_DEVEL_PREFIX}/lib/quadcore
    INSTALL_RPATH $ORIGIN/..)
endfunction()

foreach(folder messages parameters master flight logs gazebo topics services controller node)
  add_subdirectory(cpp/ros/${folder})
endforeach()
install(TARGETS quadcore_node controller_node RUNTIME DESTINATION lib/quadcore)
if(QUADCORE_BUILD_BENCHMARKS)
  quadcore_add_ros_node(ros_probe benchmarks/ros_probe.cpp)
  install(TARGETS ros_probe RUNTIME DESTINATION lib/quadcore)
endif()

# Not catkin_install_python, which would fix the interpreter: these scripts use the one with quadcore.
install(PROGRAMS scripts/ros/bag_player.py scripts/ros/expand_model.py
                 scripts/ros/flight_buttons.py scripts/ros/fly_from_python.py
                 scripts/ros/hector_names.py scripts/ros/play_commands.py
                 scripts/ros/show_in_rviz.py scripts/ros/spawn_model scripts/ros/view
        DESTINATION lib/quadcore)
install(FILES scripts/ros/recorded_commands.py DESTINATION lib/quadcore)

if(CATKIN_ENABLE_TESTING)
  find_package(rostest QUIET)
  if(rostest_FOUND)
    quadcore_add_ros_node(simulink_stand_in tests/ros/simulink_stand_in.cpp)
    foreach(test topics services lockstep playing logs log_per_flight clock several parameters faults
                 masters launch fly_from_python controller controller_faults set_points pid joystick
                 sensors disturbances markers tutorial lee rotors rotors_topics rotors_hover gazebo
                 gazebo_launch gazebo_tutorial pages refusals links one_world waiting building alarms
                 tools hector mrs vehicles)
      add_rostest(tests/ros/${test}.test)
    endforeach()
  endif()
endif()
