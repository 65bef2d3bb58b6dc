#include "quadcore/plugin/document.hpp"

#include <pybind11/stl.h>

#include "arguments.hpp"
#include "bindings.hpp"
#include "quadcore/gazebo_reference.hpp"
#include "quadcore/harmless_elements.hpp"
#include "quadcore/plugin/world.hpp"
#include "quadcore/text.hpp"

namespace quadcore::bindings {
namespace {

void bind_texts(py::module_& m) {
  py::class_<Document>(m, "Document", R"(An XML text and where its lines came from.

Attributes
----------
largest, largest_world : int
    Bytes that a text may have, and the text of a world.
most_levels, most_attributes : int
    Levels of elements that a text may have, and attributes of one element.)")
      .def(py::init([](std::string name, std::string text,
                       std::vector<std::pair<std::string, int>> lines) {
             return Document{std::move(name), std::move(text), std::move(lines)};
           }),
           py::arg("name"), py::arg("text"),
           py::arg("lines") = std::vector<std::pair<std::string, int>>{})
      .def("__repr__",
           [](const Document& d) {
             return py::str("<Document '{}', {} characters>").format(text(d.name), d.text.size());
           })
      .def_readonly("name", &Document::name, "File name for error messages.")
      .def_readonly("text", &Document::text, "XML text.")
      .def_readonly("lines", &Document::lines,
                    "Source file and line of each line of an expanded text; empty if the text is "
                    "the file itself.")
      .def_property_readonly_static("largest", [](const py::object&) { return Document::largest; })
      .def_property_readonly_static("largest_world",
                                    [](const py::object&) { return Document::largest_world; })
      .def_property_readonly_static("most_levels",
                                    [](const py::object&) { return Document::most_levels; })
      .def_property_readonly_static("most_attributes",
                                    [](const py::object&) { return Document::most_attributes; });

  py::class_<IgnoredElements>(m, "IgnoredElements", "Elements that a reader found but did not use.")
      .def_property_readonly("ignored", &IgnoredElements::ignored,
                             "Names of the elements that the user ignored.")
      .def_property_readonly("warning", &IgnoredElements::warning,
                             "Warning about elements without effect on the motion, or \"\".")
      .def_property_readonly(
          "unsimulated", &IgnoredElements::unsimulated,
          "Parts of the world that may affect the motion but are not simulated, list of str.");

  py::class_<HarmlessElement>(m, "HarmlessElement",
                              "Element or module without effect on the motion.")
      .def_readonly("name", &HarmlessElement::name,
                    "Name of the element, or file name of the module.")
      .def_readonly("parent", &HarmlessElement::parent,
                    "Parent element, such as \"robot/link\"; \"\" for a module.")
      .def_readonly("what", &HarmlessElement::what,
                    "Purpose of the element, or output of the module.");
}

void bind_tables(py::module_& m) {
  m.def("parse_number", &parse_number, py::arg("text"),
        "Return the finite number in a text, as in a URDF, or None.");
  py::class_<GazeboTag>(m, "GazeboTag", "Tag of a <gazebo reference>.")
      .def_readonly("name", &GazeboTag::name, "Name of the tag.")
      .def_readonly("of", &GazeboTag::of,
                    "Kind of element that the reference must name: link or joint.")
      .def_readonly("affects", &GazeboTag::affects,
                    "Objects that the tag affects: shapes, body or joint; \"\" for none.")
      .def_readonly("unit", &GazeboTag::unit, "Unit, or \"\".")
      .def_readonly("default", &GazeboTag::fallback, "Default value, or \"\".")
      .def_readonly("range", &GazeboTag::range, "Valid values as readable text.")
      .def_readonly("meaning", &GazeboTag::meaning, "Meaning in one line.");
  m.def("gazebo_tags", &gazebo_tags,
        "Return all tags of <gazebo reference>, those with an effect first.");
  m.def("world_elements", &world_elements,
        "Return the elements of a world file, named by their paths below <world>.");
  m.def("list_harmless_elements", &list_harmless_elements,
        "Return the known elements and modules without effect on the motion.");
  m.def("check_ignored", &check_ignored, py::arg("ignore"), py::arg("readings"),
        "Raise InputError if a name to ignore was found in none of the documents.");
}

}  // namespace

void bind_document(py::module_& m) {
  bind_texts(m);
  bind_tables(m);
}

}  // namespace quadcore::bindings
