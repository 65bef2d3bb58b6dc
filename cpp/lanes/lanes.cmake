# quadcore_compile_lanes(TARGET SOURCE OPTION...): adds SOURCE to TARGET once for each width of lanes,
# compiled with the options, each time with that QUADCORE_LANES defined and the instructions of the
# processors that have registers of that width; lane_width.hpp chooses one. SOURCE includes only what
# may be compiled so: see cpp/lanes/pack.hpp.
function(quadcore_compile_lanes target source)
  get_filename_component(name ${source} NAME_WE)
  foreach(lanes 1 2 4 8)
    set(object ${target}_${name}${lanes})
    add_library(${object} OBJECT ${source})
    target_include_directories(${object} PRIVATE ${PROJECT_SOURCE_DIR}/cpp
                                                 ${PROJECT_SOURCE_DIR}/cpp/core/include)
    target_compile_definitions(${object} PRIVATE QUADCORE_LANES=${lanes})
    set_target_properties(${object} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    # Vectors never cross a function that is not inlined, so how they would be passed is of no concern.
    # What the compiler would vectorise by itself are vectors of three, written as scalars just before:
    # reading them back at once stalls.
    target_compile_options(${object} PRIVATE -O3 -ffp-contract=off -fno-math-errno
                                             -fno-trapping-math
                                             -fno-tree-vectorize
                                             -fno-tree-slp-vectorize
                                             -Wno-psabi ${ARGN})
    if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
      target_compile_options(${object} PRIVATE -fno-tree-loop-distribute-patterns)
    endif()
    if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
      if(lanes EQUAL 4)
        target_compile_options(${object} PRIVATE -mavx2)
      elseif(lanes EQUAL 8)
        target_compile_options(${object} PRIVATE -mavx512f)
      endif()
    endif()
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${object}>)
    # For who takes the objects of the target.
    set_property(TARGET ${target} APPEND PROPERTY lane_objects $<TARGET_OBJECTS:${object}>)
  endforeach()
endfunction()
