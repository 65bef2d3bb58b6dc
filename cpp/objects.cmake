# quadcore_add_objects(NAME SOURCE...) makes a library of one folder, whose objects become part of
# libquadcore. That folder is the include root of its headers. Link the libraries below it, as
# CONTRIBUTING.md orders them, and no others: then an include that points upwards does not compile.
function(quadcore_add_objects name)
  add_library(${name} OBJECT ${ARGN})
  target_include_directories(${name} PUBLIC ${CMAKE_CURRENT_SOURCE_DIR})
  # To clang the definition of a function is hidden unless its own namespace block is marked, as that
  # of the declaration is. libquadcore exports all of the namespace.
  if(BUILD_SHARED_LIBS AND CMAKE_CXX_COMPILER_ID MATCHES Clang)
    set_target_properties(${name} PROPERTIES CXX_VISIBILITY_PRESET default)
  endif()
  set_property(GLOBAL APPEND PROPERTY quadcore_objects $<TARGET_OBJECTS:${name}>)
endfunction()
