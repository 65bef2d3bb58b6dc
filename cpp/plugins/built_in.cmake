# quadcore_build_in(TARGET PLUGIN...): gives a target the table of the plugins that it has inside, each
# under its own symbol; a shared core has none.
function(quadcore_build_in target)
  set(declarations "")
  set(entries "")
  foreach(plugin ${ARGN})
    set(symbol quadcore_${plugin}_plugin)
    string(APPEND declarations "extern \"C\" const quadcore::PluginModule ${symbol};\n")
    string(APPEND entries "\n      {\"lib${${plugin}_module}.so\", &${symbol}},")
  endforeach()
  set(table ${CMAKE_CURRENT_BINARY_DIR}/${target}_built_in_plugins.cpp)
  configure_file(${PROJECT_SOURCE_DIR}/cpp/plugins/built_in_plugins.cpp.in ${table} @ONLY)
  target_sources(${target} PRIVATE ${table})
endfunction()
