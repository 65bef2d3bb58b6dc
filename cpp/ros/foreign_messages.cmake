# Generates the headers of the messages in cpp/ros/packages, for the node alone. The system may have
# larger packages of these names, or none.

set(foreign_dir ${PROJECT_BINARY_DIR}/foreign)
set(foreign_headers "")
set(foreign_flags "")
foreach(package std_msgs geometry_msgs)
  include(${${package}_DIR}/${package}-msg-paths.cmake)
  list(APPEND foreign_flags -I${package}:${${package}_MSG_INCLUDE_DIRS})
endforeach()
file(GLOB foreign_folders ${CMAKE_CURRENT_LIST_DIR}/packages/*/msg)
foreach(folder ${foreign_folders})
  get_filename_component(package ${folder} DIRECTORY)
  get_filename_component(package ${package} NAME)
  list(APPEND foreign_flags -I${package}:${folder})
endforeach()

file(GLOB foreign_files ${CMAKE_CURRENT_LIST_DIR}/packages/*/msg/*.msg
                        ${CMAKE_CURRENT_LIST_DIR}/packages/*/srv/*.srv)
foreach(file ${foreign_files})
  get_filename_component(name ${file} NAME_WE)
  get_filename_component(package ${file} DIRECTORY)
  get_filename_component(package ${package} DIRECTORY)
  get_filename_component(package ${package} NAME)
  set(header ${foreign_dir}/${package}/${name}.h)
  add_custom_command(
    OUTPUT ${header}
    COMMAND ${CATKIN_ENV} ${PYTHON_EXECUTABLE} ${GENCPP_BIN} ${file} ${foreign_flags} -p ${package}
            -o ${foreign_dir}/${package} -e ${GENCPP_TEMPLATE_DIR}
    DEPENDS ${file} ${GENCPP_BIN}
    COMMENT "Generating C++ of ${package}/${name}"
    VERBATIM)
  list(APPEND foreign_headers ${header})
endforeach()
add_custom_target(foreign_messages DEPENDS ${foreign_headers})
