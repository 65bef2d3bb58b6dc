# The shipped plugins, and which of them have laws in lanes.
set(QUADCORE_PLUGINS aerodynamic barometer battery controller fault gps ground_effect imu magnetometer
  motor motorpid odometry payload push reference wind)
set(aerodynamic_lanes rotor_forces_lanes.cpp)
set(motorpid_lanes motor_torques_lanes.cpp)

# quadcore_add_plugin_sources(TARGET PLUGIN): a module is made of them, or a static core.
function(quadcore_add_plugin_sources target plugin)
  set(folder ${PROJECT_SOURCE_DIR}/cpp/plugins/${plugin})
  target_sources(${target} PRIVATE ${folder}/${plugin}_plugin.cpp)
  if(${plugin}_lanes)
    quadcore_compile_lanes(${target} ${folder}/${${plugin}_lanes})
  endif()
endfunction()
