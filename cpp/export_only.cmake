# Leaves those symbols in a shared library's table that match a pattern. Hidden visibility alone would
# leave the templates of the standard library beside them.
function(export_only target)
  string(JOIN "; " symbols ${ARGN})
  set(map ${CMAKE_CURRENT_BINARY_DIR}/${target}.map)
  file(GENERATE OUTPUT ${map} CONTENT "{ global: ${symbols}; local: *; };\n")
  target_link_options(${target} PRIVATE LINKER:--version-script=${map})
  set_target_properties(${target} PROPERTIES LINK_DEPENDS ${map})
endfunction()
