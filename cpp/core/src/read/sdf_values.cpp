#include "sdf_values.hpp"

#include "quadcore/text.hpp"

namespace quadcore {

const Xml::Element* descend(const Xml::Element* e, std::initializer_list<const char*> names) {
  for (const char* name : names) e = e ? e->FirstChildElement(name) : nullptr;
  return e;
}

double number_or(const Xml& xml, const Xml::Element* parent, const char* name, double fallback) {
  const Xml::Element* e = descend(parent, {name});
  return e && !xml.text(*e).empty() ? xml.number_in_text(*e) : fallback;
}

bool is_true(const Xml& xml, const Xml::Element* e) {
  if (!e) return false;
  const std::string text = lower(xml.text(*e));
  return text == "1" || text == "true";
}

}  // namespace quadcore
