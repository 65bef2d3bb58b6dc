# Exports only the symbols of a shared library that match a pattern. Hidden visibility alone would also
# export templates of the standard library.
function(export_only target)
  string(JOIN "; " symbols ${ARGN})
  set(map ${CMAKE_CURRENT_BINARY_DIR}/${target}.map)
  file(GENERATE OUTPUT ${map} CONTENT "{ global: ${symbols}; local: *; };\n")
  target_link_options(${target} PRIVATE LINKER:--version-script=${map})
  set_target_properties(${target} PROPERTIES LINK_DEPENDS ${map})
endfunction()
