# quadcore_compile_lanes(TARGET SOURCE [INCLUDE FOLDER...] [OPTIONS OPTION...]) compiles SOURCE with the
# options once for each lane width and adds the objects to TARGET. Each time it defines QUADCORE_LANES
# and uses the instructions of processors with registers of that width; lane_width.hpp selects one.
# SOURCE may include only headers that allow this: see cpp/physics/lanes/pack.hpp.
function(quadcore_compile_lanes target source)
  cmake_parse_arguments(PARSE_ARGV 2 given "" "" "INCLUDE;OPTIONS")
  get_filename_component(name ${source} NAME_WE)
  get_target_property(type ${target} TYPE)
  foreach(lanes 1 2 4 8)
    set(object ${target}_${name}${lanes})
    add_library(${object} OBJECT ${source})
    target_link_libraries(${object} PRIVATE quadcore_physics)
    target_include_directories(${object} PRIVATE ${given_INCLUDE})
    target_compile_definitions(${object} PRIVATE QUADCORE_LANES=${lanes})
    # All functions with vectors are inlined, so their calling convention does not matter. Automatic
    # vectorisation would affect only three-vectors that have just been written as scalars, and reading
    # them back at once stalls.
    target_compile_options(${object} PRIVATE -O3 -ffp-contract=off -fno-math-errno
                                             -fno-trapping-math
                                             -fno-tree-vectorize
                                             -fno-tree-slp-vectorize
                                             -Wno-psabi ${given_OPTIONS})
    if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
      target_compile_options(${object} PRIVATE -fno-tree-loop-distribute-patterns)
    endif()
    if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
      if(lanes EQUAL 4)
        target_compile_options(${object} PRIVATE -mavx2)
      elseif(lanes EQUAL 8)
        target_compile_options(${object} PRIVATE -mavx512f -mavx512vl -mavx512dq)
      endif()
    endif()
    quadcore_list_objects(objects ${object})
    if(type STREQUAL OBJECT_LIBRARY)  # which cannot pass on the objects of another
      set_property(GLOBAL APPEND PROPERTY quadcore_objects ${objects})
    else()
      target_sources(${target} PRIVATE ${objects})
    endif()
  endforeach()
endfunction()
