# A static core has the shipped plugins inside, each under a symbol of its own, and a table of them;
# the table of a shared core is empty. Included where the core is made.
set(declarations "")
set(entries "")
if(NOT BUILD_SHARED_LIBS)
  foreach(plugin ${QUADCORE_PLUGINS})
    set(symbol quadcore_${plugin}_plugin)
    quadcore_add_plugin_sources(quadcore ${plugin})
    set_source_files_properties(${PROJECT_SOURCE_DIR}/cpp/plugins/${${plugin}_source}
      PROPERTIES COMPILE_DEFINITIONS QUADCORE_PLUGIN_SYMBOL=${symbol})
    string(APPEND declarations "extern \"C\" const quadcore::PluginModule ${symbol};\n")
    string(APPEND entries "\n      {\"lib${${plugin}_module}.so\", &${symbol}},")
  endforeach()
endif()
configure_file(../plugins/built_in_plugins.cpp.in built_in_plugins.cpp @ONLY)
target_sources(quadcore PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/built_in_plugins.cpp)
