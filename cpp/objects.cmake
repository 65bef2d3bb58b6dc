# A build lists the objects of its targets in the folder "objects" of its build folder. Another build,
# configured with QUADCORE_OBJECTS_OF=<that build folder>, links them instead of compiling them again.
# Both must have the same sources and options. A static core has its own table of plugins; all its other
# objects are those of a shared core.

# quadcore_list_objects(VARIABLE TARGET) stores the objects that stand for TARGET in VARIABLE.
function(quadcore_list_objects variable target)
  string(REGEX REPLACE "_objects$" "" name ${target})  # a plugin's, which is a module in a shared build
  if(QUADCORE_OBJECTS_OF AND (BUILD_SHARED_LIBS OR NOT name STREQUAL quadcore_built_in_plugins))
    file(STRINGS ${QUADCORE_OBJECTS_OF}/objects/${name} objects)
    set_target_properties(${target} PROPERTIES EXCLUDE_FROM_ALL ON)
  else()
    set(objects $<FILTER:$<TARGET_OBJECTS:${target}>,EXCLUDE,[.]gch>)  # no precompiled header
    file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/objects/${name} CONTENT "$<JOIN:${objects},\n>\n")
  endif()
  set(${variable} ${objects} PARENT_SCOPE)
endfunction()

# quadcore_add_objects(NAME [LESS_OPTIMISED] SOURCE...) creates an object library of one folder, which becomes
# part of libquadcore. See quadcore_optimise_less() for the option. The folder is the include root of its
# headers. Link only the libraries below it in the order of CONTRIBUTING.md, so that an include of a higher
# layer does not compile.
function(quadcore_add_objects name)
  cmake_parse_arguments(PARSE_ARGV 1 given LESS_OPTIMISED "" "")
  add_library(${name} OBJECT ${given_UNPARSED_ARGUMENTS})
  target_include_directories(${name} PUBLIC ${CMAKE_CURRENT_SOURCE_DIR})
  # Clang hides the definition of a function unless its own namespace block is marked like that of the
  # declaration. libquadcore exports the whole namespace.
  if(BUILD_SHARED_LIBS AND CMAKE_CXX_COMPILER_ID MATCHES Clang)
    set_target_properties(${name} PROPERTIES CXX_VISIBILITY_PRESET default)
  endif()
  if(given_LESS_OPTIMISED)
    quadcore_optimise_less(${name})
  endif()
  quadcore_precompile(${name})
  quadcore_list_objects(objects ${name})
  set_property(GLOBAL APPEND PROPERTY quadcore_objects ${objects})
endfunction()
