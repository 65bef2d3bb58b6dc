# quadcore_compile_lanes(TARGET SOURCE [ROTORS] [INCLUDE FOLDER...] [OPTIONS OPTION...]) compiles SOURCE with the
# options once for each lane width and adds the objects to TARGET. Each time it defines QUADCORE_LANES
# and uses the instructions of processors with registers of that width; lane_width.hpp selects one. With
# ROTORS, whose packs of four suit most vehicles, it compiles these for the 32 registers of AVX-512, too, and
# defines QUADCORE_HAS_32_REGISTERS as true for them.
# SOURCE may include only headers that allow this: see cpp/physics/lanes/pack.hpp.
function(quadcore_compile_lanes target source)
  cmake_parse_arguments(PARSE_ARGV 2 given "ROTORS" "" "INCLUDE;OPTIONS")
  get_filename_component(name ${source} NAME_WE)
  get_target_property(type ${target} TYPE)
  set(sets 1 2 4 8)
  if(given_ROTORS)
    list(APPEND sets 4_of_32)
  endif()
  foreach(set ${sets})
    string(REGEX MATCH "^[0-9]" lanes ${set})
    set(has_32_registers false)
    if(set STREQUAL 4_of_32)
      set(has_32_registers true)
    endif()
    set(object ${target}_${name}${set})
    add_library(${object} OBJECT ${source})
    target_link_libraries(${object} PRIVATE quadcore_physics)
    target_include_directories(${object} PRIVATE ${given_INCLUDE})
    target_compile_definitions(${object} PRIVATE QUADCORE_LANES=${lanes}
      QUADCORE_HAS_32_REGISTERS=${has_32_registers})
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
      if(lanes EQUAL 8 OR has_32_registers)
        target_compile_options(${object} PRIVATE -mavx512f -mavx512vl -mavx512dq)
      elseif(lanes EQUAL 4)
        target_compile_options(${object} PRIVATE -mavx2)
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
