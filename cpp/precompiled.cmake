# quadcore_precompile(TARGET [HEADER...]) compiles TARGET with precompiled headers, HEADER among them. Targets
# with the same HEADER share them and must have the same options. Only unity builds do so, because they
# compile everything at once. Other builds compile each source alone, so that a missing include is an error.
# clang demands equal definitions in all targets, so only GCC does it.
function(quadcore_precompile target)
  if(NOT CMAKE_UNITY_BUILD OR NOT CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    return()
  endif()
  # Without the first, ccache compiles each time. The second saves the compiler most of its collections of
  # garbage, a twentieth of its time.
  target_compile_options(${target} PRIVATE -fpch-preprocess --param=ggc-min-heapsize=524288)  # KiB
  get_property(first GLOBAL PROPERTY "quadcore_precompiled ${ARGN}")
  if(first)
    target_precompile_headers(${target} REUSE_FROM ${first})
  else()
    set_property(GLOBAL PROPERTY "quadcore_precompiled ${ARGN}" ${target})
    target_precompile_headers(${target} PRIVATE
      ${ARGN}
      <Eigen/Core> <Eigen/Geometry> <algorithm> <array> <cmath> <cstdint> <functional> <limits> <map>
      <memory> <optional> <set> <sstream> <string> <string_view> <utility> <variant> <vector>
      <quadcore/plugin/topics.hpp> <quadcore/plugin/vehicle_description.hpp>
      <quadcore/plugin/world.hpp>)
  endif()
endfunction()
