# quadcore_precompile(TARGET) compiles TARGET with precompiled headers. Only unity builds do so, because
# they compile everything at once. Other builds compile each source alone, so that a missing include is
# an error. clang demands equal definitions in all targets, so only GCC does it.
function(quadcore_precompile target)
  if(NOT CMAKE_UNITY_BUILD OR NOT CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    return()
  endif()
  target_compile_options(${target} PRIVATE -fpch-preprocess)  # without it, ccache compiles each time
  get_property(first GLOBAL PROPERTY quadcore_precompiled)
  if(first)
    target_precompile_headers(${target} REUSE_FROM ${first})
  else()
    set_property(GLOBAL PROPERTY quadcore_precompiled ${target})
    target_precompile_headers(${target} PRIVATE
      <Eigen/Core> <Eigen/Geometry> <algorithm> <array> <cmath> <cstdint> <functional> <limits> <map>
      <memory> <optional> <set> <sstream> <string> <string_view> <utility> <variant> <vector>
      <quadcore/plugin/topics.hpp> <quadcore/plugin/vehicle_description.hpp>
      <quadcore/plugin/world.hpp>)
  endif()
endfunction()
