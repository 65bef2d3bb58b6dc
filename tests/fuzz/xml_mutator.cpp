#include "xml_mutator.hpp"

#include <cstdio>
#include <set>

#include "grammar.hpp"

namespace {

void collect(tinyxml2::XMLElement& element, std::vector<tinyxml2::XMLElement*>& all) {
  all.push_back(&element);
  for (auto* child = element.FirstChildElement(); child; child = child->NextSiblingElement()) {
    collect(*child, all);
  }
}

std::vector<tinyxml2::XMLElement*> elements(const tinyxml2::XMLDocument& document) {
  std::vector<tinyxml2::XMLElement*> all;
  auto* root = const_cast<tinyxml2::XMLElement*>(document.RootElement());
  if (root) collect(*root, all);
  return all;
}

std::vector<std::pair<std::string, std::string>> attributes(const tinyxml2::XMLElement& element) {
  std::vector<std::pair<std::string, std::string>> all;
  for (const auto* a = element.FirstAttribute(); a; a = a->Next()) {
    all.emplace_back(a->Name(), a->Value());
  }
  return all;
}

std::string printed(const tinyxml2::XMLDocument& document) {
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

const std::set<std::string> vectors = {"xyz",     "rpy",    "size",
                                       "gravity", "normal", "linear_velocity"};
const std::set<std::string> texts = {
    "name",   "type",      "link",      "filename",  "reference",   "version",    "uri",
    "static", "dragModel", "frameLink", "publishTf", "rotorJoints", "twistFrame", "reactionTorque"};

}  // namespace

std::string XmlMutator::mutated(const std::string& text) {
  Document document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) return text;
  for (std::size_t n = 1 + below(4); n > 0; --n) mutate(document);
  return printed(document);
}

std::string XmlMutator::crossed(const std::string& text, const std::string& other) {
  Document document, donor;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) return text;
  if (donor.Parse(other.data(), other.size()) != tinyxml2::XML_SUCCESS) return text;
  const auto places = elements(document), gifts = elements(donor);
  if (places.empty() || gifts.empty()) return text;
  any(places)->InsertEndChild(any(gifts)->DeepClone(&document));
  return printed(document);
}

void XmlMutator::mutate(Document& document) {
  const auto all = elements(document);
  if (all.empty()) return;
  Element& element = *any(all);
  Element& other = *any(all);
  const bool root = &element == document.RootElement();
  switch (below(10)) {
    case 0:
      if (!root) element.Parent()->DeleteChild(&element);
      return;
    case 1:
      other.InsertEndChild(element.DeepClone(&document));
      return;
    case 2:
      if (!root) element.Parent()->InsertAfterChild(&element, element.DeepClone(&document));
      return;
    case 3:
      add_child(element, child_name(element), 3);
      return;
    case 4: {
      const std::string name = chance(2) ? other.Name() : child_name(other);
      element.SetName(name.c_str());
      return;
    }
    case 5: {
      const auto present = attributes(element);
      if (!present.empty()) element.DeleteAttribute(any(present).first.c_str());
      return;
    }
    case 6:
      if (chance(8)) nest(element);
      return;
    default:
      set_value(element);
  }
}

XmlMutator::Element* XmlMutator::add_child(Element& parent, const std::string& name, int depth) {
  Element* child = parent.GetDocument()->NewElement(name.c_str());
  parent.InsertEndChild(child);
  const auto rule = grammar().find(name);
  if (rule == grammar().end() || (rule->second.attributes.empty() && chance(4))) {
    child->SetText(value(name, *parent.GetDocument()).c_str());
    return child;
  }
  for (const std::string& attribute : rule->second.attributes) {
    child->SetAttribute(attribute.c_str(), value(attribute, *parent.GetDocument()).c_str());
  }
  if (depth == 0) return child;
  for (const std::string& grandchild : rule->second.children) {
    if (chance(2)) add_child(*child, grandchild, depth - 1);
  }
  return child;
}

void XmlMutator::set_value(Element& element) {
  const Document& document = *element.GetDocument();
  const auto present = attributes(element);
  const auto rule = grammar().find(element.Name());
  if (!present.empty() && !chance(4)) {
    const std::string& name = any(present).first;
    element.SetAttribute(name.c_str(), value(name, document).c_str());
  } else if (rule != grammar().end() && !rule->second.attributes.empty()) {
    const std::string& name = any(rule->second.attributes);
    element.SetAttribute(name.c_str(), value(name, document).c_str());
  } else {
    element.SetText(value(element.Name(), document).c_str());
  }
}

/// Wraps an element into many of its own kind.
void XmlMutator::nest(Element& element) {
  Element* at = &element;
  for (std::size_t depth = 1 + below(120); depth > 0; --depth) {
    Element* inner = element.GetDocument()->NewElement(element.Name());
    at->InsertEndChild(inner);
    at = inner;
  }
}

std::string XmlMutator::value(const std::string& of, const Document& document) {
  if (chance(3)) {  // a name used elsewhere, or a value out of place
    const auto found = attributes(*any(elements(document)));
    if (!found.empty()) return any(found).second;
  }
  if (chance(12)) return any(chance(2) ? words() : numbers());
  if (texts.count(of)) return any(words());
  if (!vectors.count(of)) return number();
  std::string vector = number();
  for (int i = 1; i < 3 || chance(20); ++i) vector += " " + number();
  return vector;
}

std::string XmlMutator::number() {
  if (chance(2)) return any(numbers());
  char text[32];
  const double scale = std::uniform_real_distribution<double>(-6, 4)(random_);
  std::snprintf(text, sizeof text, "%s%.6ge%d", chance(4) ? "-" : "",
                std::uniform_real_distribution<double>(1, 10)(random_), static_cast<int>(scale));
  return text;
}

std::string XmlMutator::child_name(const Element& parent) {
  const auto rule = grammar().find(parent.Name());
  if (rule != grammar().end() && !rule->second.children.empty() && !chance(8)) {
    return any(rule->second.children);
  }
  auto it = grammar().begin();
  std::advance(it, static_cast<long>(below(grammar().size())));
  return it->first;
}
