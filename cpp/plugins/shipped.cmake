# The shipped plugins, and those with force laws for several rotors at once.
set(QUADCORE_PLUGINS aerodynamic barometer battery ceiling_effect controller downwash fault gps ground_effect imu lidar
  magnetometer motor motorpid odometry payload push range reference tachometer wind)
set(aerodynamic_lanes aerodynamic/rotor_forces_lanes.cpp)
set(motorpid_lanes motorpid/motor_torques_lanes.cpp)
foreach(plugin ${QUADCORE_PLUGINS})
  set(${plugin}_source ${plugin}/${plugin}_plugin.cpp)
  set(${plugin}_module ${plugin}_plugin)
endforeach()
# Replacements of RotorS' modules have the same names.
foreach(source motor_model controller_interface multirotor_base gps imu magnetometer odometry
               pressure wind)
  list(APPEND QUADCORE_PLUGINS rotors_${source})
  set(rotors_${source}_source rotors/${source}.cpp)
  set(rotors_${source}_module rotors_gazebo_${source})
endforeach()
foreach(source multirotor_base gps imu magnetometer odometry pressure wind)
  set(rotors_${source}_module rotors_gazebo_${source}_plugin)
endforeach()
