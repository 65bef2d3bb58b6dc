#include "xml.hpp"

#include <cmath>

#include "quadcore/harmless_elements.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/text.hpp"
#include "xml_limits.hpp"

namespace quadcore {
namespace {

/// Bytes of a world with the models and meshes that it includes.
constexpr std::size_t largest_with_meshes = 500000000;

std::string list_accepted(const Xml::Element& element, const std::vector<std::string>& names) {
  return names.empty() ? " Remove it."
                       : " <" + std::string(element.Name()) + "> accepts " + joined(names) + ".";
}

}  // namespace

Xml::Xml(const Document& document, const std::string& root_name, IgnoredElements& ignored_elements,
         const std::string& old_name)
    : document_(document), ignored_elements_(ignored_elements) {
  const bool is_world = root_name == "sdf", has_embedded = !document.lines.empty();
  check_xml_limits(document, is_world && has_embedded ? largest_with_meshes
                             : is_world               ? Document::largest_world
                                                      : Document::largest);
  if (trimmed(document.text).empty()) {
    throw InputError(document.at(1) + ": the file is empty. Write a <" + root_name + "> element.");
  }
  if (xml_.Parse(document.text.data(), document.text.size()) != tinyxml2::XML_SUCCESS) {
    std::string what = xml_.ErrorStr();
    const auto line = what.find("Error=");
    if (line != std::string::npos) what = what.substr(line);
    for (char& c : what) c = c == '\n' ? ' ' : c;
    const int number = xml_.ErrorLineNum() > 0 ? xml_.ErrorLineNum() : 1;
    throw InputError(document.at(number) + ": malformed XML (" + what + "). Correct this line.");
  }
  for (const auto* node = xml_.FirstChild(); node; node = node->NextSibling()) {
    if (node->ToUnknown()) {
      throw InputError(document.at(node->GetLineNum()) +
                       ": <!DOCTYPE> and entities are not supported. Remove them.");
    }
  }
  const auto* root = xml_.RootElement();
  if (!root || (root_name != root->Name() && old_name != root->Name())) {
    throw InputError(document.at(root ? root->GetLineNum() : 1) + ": the outermost element is " +
                     (root ? "<" + std::string(root->Name()) + ">" : std::string("missing")) +
                     ". Use <" + root_name + ">.");
  }
}

void Xml::fail(const Element& element, const std::string& what) const {
  throw InputError(where(element) + ": " + what);
}

std::vector<const Xml::Element*> Xml::children(const Element& element,
                                               const std::set<std::string>& allowed,
                                               const std::set<std::string>& repeatable) const {
  std::vector<const Element*> found;
  std::set<std::string> seen;
  for (const auto* node = element.FirstChild(); node; node = node->NextSibling()) {
    if (node->ToText()) {
      const std::string place = document_.at(node->GetLineNum());
      const std::string parent = "in <" + std::string(element.Name()) + ">";
      if (decide_on_text(path(element)) == Handling::reject) {
        throw InputError(place + ": stray text '" + trimmed(node->Value()) + "' " + parent +
                         ". Remove it.");
      }
      ignored_elements_.add_harmless("text " + parent, place);
    }
    const Element* child = node->ToElement();
    if (!child) continue;
    const std::string name = child->Name();
    if (!allowed.count(name)) {
      skip_or_fail(element, *child, allowed);
      continue;
    }
    if (!seen.insert(name).second && !repeatable.count(name)) {
      const std::string what = "a second <" + name + "> in <" + element.Name() + ">";
      if (decide_on_excess(path(element)) == Handling::reject) {
        fail(*child, what + ". Keep one of them.");
      }
      ignored_elements_.add_harmless(what, where(*child));
      continue;
    }
    found.push_back(child);
  }
  return found;
}

std::string Xml::path(const Element& element) const {
  const std::string name = element.Name();
  return &element == &root() ? name : root().Name() + ("/" + name);
}

void Xml::skip_or_fail(const Element& parent, const Element& child,
                       const std::set<std::string>& allowed) const {
  const std::string name = child.Name();
  const std::vector<std::string> names(allowed.begin(), allowed.end());
  const std::string similar = suggest(name, names);
  const Handling handling = decide_on_element(path(parent), name, !similar.empty());
  if (handling != Handling::reject && ignored_elements_.ignores({name})) return;
  if (handling == Handling::skip)
    return ignored_elements_.add_harmless("<" + name + ">", where(child));
  if (name.rfind("xacro:", 0) == 0 && root().Name() == std::string("robot")) {
    fail(child, "<" + name +
                    "> is an xacro element, which is expanded only in files named *.xacro. Rename "
                    "the file.");
  }
  fail(child, "<" + name + "> in <" + parent.Name() + "> is not supported." + similar +
                  list_accepted(parent, names) +
                  (handling == Handling::reject_unless_ignored ? suggest_ignoring(name) : ""));
}

const Xml::Element& Xml::required_child(const Element& element, const char* name) const {
  const Element* found = element.FirstChildElement(name);
  if (!found) {
    fail(element, "<" + std::string(element.Name()) + "> requires a <" + name + ">. Add one.");
  }
  return *found;
}

void Xml::only_attributes(const Element& element, const std::set<std::string>& allowed) const {
  for (const auto* a = element.FirstAttribute(); a; a = a->Next()) {
    const std::string name = a->Name();
    if (allowed.count(name) || name.rfind("xmlns", 0) == 0) continue;
    if (name.find(':') != std::string::npos) {
      ignored_elements_.add_harmless("attribute " + name, where(element));
      continue;
    }
    const std::vector<std::string> names(allowed.begin(), allowed.end());
    const std::string similar = suggest(name, names);
    const std::string what = "attribute " + name + " of <" + element.Name() + ">";
    if (similar.empty() && decide_on_excess(path(element)) == Handling::skip) {
      if (*a->Value()) ignored_elements_.add_harmless(what, where(element));
      continue;
    }
    fail(element, what + " is not supported." + similar + list_accepted(element, names));
  }
}

void Xml::attributes_alone(const Element& element, const std::set<std::string>& allowed) const {
  only_attributes(element, allowed);
  children(element, {});
}

std::string Xml::attribute(const Element& element, const char* name) const {
  const char* value = element.Attribute(name);
  const std::string text = value ? trimmed(value) : "";
  if (text.empty()) {
    fail(element, "<" + std::string(element.Name()) + "> requires the attribute " + name +
                      ". Add " + name + "=\"...\".");
  }
  return text;
}

double Xml::number(const Element& element, const char* name) const {
  return as_number(element, std::string(name) + " of <" + element.Name() + ">",
                   attribute(element, name));
}

double Xml::number(const Element& element, const char* name, double fallback) const {
  return element.Attribute(name) ? number(element, name) : fallback;
}

Vector3d Xml::vector(const Element& element, const char* name, const Vector3d& fallback) const {
  if (!element.Attribute(name)) return fallback;
  return as_vector(element, std::string(name) + " of <" + element.Name() + ">",
                   attribute(element, name));
}

std::string Xml::text(const Element& element, const std::set<std::string>& attributes) const {
  only_attributes(element, attributes);
  const tinyxml2::XMLText* text = nullptr;
  for (const auto* node = element.FirstChild(); node; node = node->NextSibling()) {
    if (const Element* inner = node->ToElement()) {
      fail(*inner, "<" + std::string(inner->Name()) + "> inside <" + element.Name() +
                       ">, which accepts only text. Remove it.");
    }
    if (!node->ToText()) continue;
    if (text) {
      fail(element, "the text of <" + std::string(element.Name()) +
                        "> is interrupted by a comment. Move the comment out of the element.");
    }
    text = node->ToText();
  }
  return text ? trimmed(text->Value()) : "";
}

double Xml::number_in_text(const Element& element) const {
  return as_number(element, "<" + std::string(element.Name()) + ">", text(element));
}

Vector3d Xml::vector_in_text(const Element& element) const {
  return as_vector(element, "<" + std::string(element.Name()) + ">", text(element));
}

void Xml::check_size(const Element& element, const std::string& what, double value) const {
  // Larger values are no length, mass or rate of a vehicle, and their products could overflow.
  if (std::abs(value) > 1e9) fail(element, what + " exceeds 1e9. Use SI units.");
}

double Xml::as_number(const Element& element, const std::string& what,
                      const std::string& text) const {
  const auto value = parse_number(text);
  if (!value) fail(element, what + " is '" + text + "'. Write one finite number.");
  check_size(element, what, *value);
  return *value;
}

Vector3d Xml::as_vector(const Element& element, const std::string& what,
                        const std::string& text) const {
  const auto value = parse_vector(text);
  if (!value) fail(element, what + " is '" + text + "'. Write three finite numbers.");
  check_size(element, what, value->cwiseAbs().maxCoeff());
  return *value;
}

}  // namespace quadcore
