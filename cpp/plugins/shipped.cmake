# The shipped plugins, and which of them have laws in lanes.
set(QUADCORE_PLUGINS aerodynamic barometer battery controller fault gps ground_effect imu magnetometer
  motor motorpid odometry payload push reference wind)
set(aerodynamic_lanes rotor_forces_lanes.cpp)
set(motorpid_lanes motor_torques_lanes.cpp)
foreach(plugin ${QUADCORE_PLUGINS})
  set(${plugin}_source ${plugin}/${plugin}_plugin.cpp)
  set(${plugin}_module ${plugin}_plugin)
endforeach()
# Those that do what RotorS' modules do have their names.
foreach(source motor_model controller_interface multirotor_base gps imu magnetometer odometry
               pressure wind)
  list(APPEND QUADCORE_PLUGINS rotors_${source})
  set(rotors_${source}_source rotors/${source}.cpp)
  set(rotors_${source}_module rotors_gazebo_${source})
endforeach()
foreach(source multirotor_base gps imu magnetometer odometry pressure wind)
  set(rotors_${source}_module rotors_gazebo_${source}_plugin)
endforeach()

# quadcore_add_plugin_sources(TARGET PLUGIN): a module is made of them, or a static core.
function(quadcore_add_plugin_sources target plugin)
  set(source ${PROJECT_SOURCE_DIR}/cpp/plugins/${${plugin}_source})
  target_sources(${target} PRIVATE ${source})
  # Each under a symbol of its own, so that several can be linked together.
  set_source_files_properties(${source} PROPERTIES
    COMPILE_DEFINITIONS QUADCORE_PLUGIN_SYMBOL=quadcore_${plugin}_plugin)
  if(${plugin}_lanes)
    quadcore_compile_lanes(${target}
      ${PROJECT_SOURCE_DIR}/cpp/plugins/${plugin}/${${plugin}_lanes})
  endif()
endfunction()
