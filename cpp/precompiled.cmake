# quadcore_optimise_less(TARGET) compiles TARGET with -O1 instead of -O3, which takes three quarters of the
# time. Use it where an engine's steps spend no time, and before quadcore_precompile().
function(quadcore_optimise_less target)
  if(CMAKE_CXX_FLAGS_RELEASE MATCHES "-O3")
    target_compile_options(${target} PRIVATE $<$<OR:$<CONFIG:>,$<CONFIG:Release>>:-O1>)
  endif()
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)  # which needs more optimisation to be right
    target_compile_options(${target} PRIVATE -Wno-error=maybe-uninitialized)
  endif()
  set_target_properties(${target} PROPERTIES QUADCORE_LESS_OPTIMISED ON)
endfunction()

# quadcore_precompile(TARGET [HEADER...]) compiles TARGET with precompiled headers, HEADER among them. Targets
# with the same HEADER and optimisation share them and must have the same options. A precompiled header
# determines the optimisation of what includes it. Only unity builds do so, because they compile everything
# at once. Other builds compile each source alone, so that a missing include is an error.
# clang demands equal definitions in all targets, so only GCC does it.
function(quadcore_precompile target)
  if(NOT CMAKE_UNITY_BUILD OR NOT CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    return()
  endif()
  # Without the first, ccache compiles each time. The second saves the compiler most of its collections of
  # garbage, a twentieth of its time.
  target_compile_options(${target} PRIVATE -fpch-preprocess --param=ggc-min-heapsize=524288)  # KiB
  get_target_property(is_less_optimised ${target} QUADCORE_LESS_OPTIMISED)
  set(shared "quadcore_precompiled ${is_less_optimised} ${ARGN}")
  get_property(first GLOBAL PROPERTY "${shared}")
  if(first)
    target_precompile_headers(${target} REUSE_FROM ${first})
  else()
    set_property(GLOBAL PROPERTY "${shared}" ${target})
    target_precompile_headers(${target} PRIVATE
      ${ARGN}
      <Eigen/Core> <Eigen/Geometry> <algorithm> <array> <cmath> <cstdint> <functional> <limits> <map>
      <memory> <optional> <set> <sstream> <string> <string_view> <utility> <variant> <vector>
      <quadcore/plugin/topics.hpp> <quadcore/plugin/vehicle_description.hpp>
      <quadcore/plugin/world.hpp>)
  endif()
endfunction()
