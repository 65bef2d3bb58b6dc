#include <pybind11/stl.h>

#include "arguments.hpp"
#include "bindings.hpp"
#include "quadcore/plugin_library.hpp"
#include "quadcore/simulation.hpp"

namespace quadcore::bindings {
namespace {

/// Return the bytes of a folder's name.
std::string path_of(const py::object& folder) {
  return py::cast<py::bytes>(py::module_::import("os").attr("fsencode")(folder));
}

/// Return the name of a tag's kind.
const char* kind_of(const Parameter& parameter) {
  switch (parameter.spec.kind) {
    case TagKind::number:
      return "number";
    case TagKind::numbers:
      return "numbers";
    case TagKind::flag:
      return "flag";
    case TagKind::choice:
      return "choice";
    case TagKind::text:
      return "text";
    case TagKind::file:
      return "file";
    case TagKind::link:
      return "link";
    case TagKind::joints:
      return "joints";
  }
  return "";
}

/// Return the name of the property that scales with a tag.
const char* effect_of(const Parameter& parameter) {
  switch (parameter.spec.effect) {
    case Effect::none:
      return "";
    case Effect::thrust:
      return "thrust";
    case Effect::drag:
      return "drag";
    case Effect::lag:
      return "lag";
  }
  return "";
}

}  // namespace

void bind_plugins(py::module_& m) {
  py::class_<Parameter>(m, "ParameterInfo", "Effective parameter of a plugin.")
      .def("__repr__",
           [](const Parameter& p) {
             return py::str("<ParameterInfo {} = {}>")
                 .format(text(p.spec.name), text(p.text.empty() ? p.spec.absent : p.text));
           })
      .def_property_readonly(
          "name", [](const Parameter& p) { return text(p.spec.name); }, "Name of the tag.")
      .def_property_readonly(
          "value", [](const Parameter& p) { return p.text.empty() ? p.spec.absent : p.text; },
          "Effective value as text.")
      .def_property_readonly(
          "kind", &kind_of,
          "Type of the value: number, numbers, flag, choice, text, file, link or joints.")
      .def_property_readonly(
          "text", [](const Parameter& p) { return text(p.text); },
          "Text given by the file or the caller, or \"\".")
      .def_property_readonly(
          "file", [](const Parameter& p) { return file_name(p.file); },
          "Resolved path; \"\" unless the kind is file.")
      .def_property_readonly(
          "unit", [](const Parameter& p) { return text(p.spec.unit); }, "Unit, or \"\".")
      .def_property_readonly(
          "default",
          [](const Parameter& p) -> std::optional<std::string> {
            if (p.spec.required) return std::nullopt;
            return p.spec.fallback.empty() ? p.spec.absent : p.spec.fallback;
          },
          "Default value; None if the tag is required.")
      .def_property_readonly(
          "range", [](const Parameter& p) { return p.spec.range(); },
          "Valid values as readable text.")
      .def_property_readonly(
          "meaning", [](const Parameter& p) { return text(p.spec.meaning); },
          "Meaning in one line.")
      .def_property_readonly(
          "equation", [](const Parameter& p) { return text(p.spec.equation); },
          "Equation or source, or \"\".")
      .def_property_readonly(
          "alias", [](const Parameter& p) { return text(p.spec.alias); },
          "Second name of the tag, or \"\".")
      .def_property_readonly(
          "effect", &effect_of,
          "Property of the vehicle that the number scales: thrust, drag or lag; \"\" for none.")
      .def_property_readonly(
          "power", [](const Parameter& p) { return p.spec.power; },
          "Exponent: scaling `effect` by f multiplies the number by f**power.")
      .def_readonly("origin", &Parameter::origin,
                    "Origin of the value: FILE:LINE, \"default\", or \"set\" by the caller.");

  py::class_<LoadedPlugin>(m, "PluginInfo", "Loaded plugin.")
      .def("__repr__",
           [](const LoadedPlugin& p) {
             return py::str("<PluginInfo '{}', {}>").format(text(p.name), text(p.filename));
           })
      .def_readonly("name", &LoadedPlugin::name,
                    "Name attribute of the plugin tag, the PLUGIN in PLUGIN.TAG.")
      .def_readonly("filename", &LoadedPlugin::filename,
                    "File name of the module as given in the tag.")
      .def_property_readonly(
          "path", [](const LoadedPlugin& p) { return file_name(p.path); },
          "Path of the loaded module.")
      .def_property_readonly(
          "summary", [](const LoadedPlugin& p) { return text(p.descriptor->summary); },
          "Summary in one line.")
      .def_property_readonly(
          "wrenches", [](const LoadedPlugin& p) { return p.descriptor->wrenches; },
          "Names of the wrenches that the plugin reports, list of str.")
      .def_property_readonly(
          "parameters", [](const LoadedPlugin& p) { return p.parameters.all(); },
          "All tags of the plugin, list of ParameterInfo.");

  m.def(
      "load_plugin_path", [](const py::object& folder) { load_plugin_path(path_of(folder)); },
      py::arg("folder"), R"(Add a folder to search for plugin libraries, before all others.

Parameters
----------
folder : str or path
    For all simulations that this process makes from now on.

Raises
------
InputError
    If it is not a folder, or cannot be searched.)");
  m.def(
      "plugin_folders",
      [] {
        py::list folders;
        for (const std::string& folder : plugin_folders()) folders.append(file_name(folder));
        return folders;
      },
      "Return the folders that are searched for plugins, in order, list of str.");
}

}  // namespace quadcore::bindings
