#include "sdf_version.hpp"

#include "quadcore/text.hpp"

namespace quadcore {

bool is_at_most_sdf(const Xml& xml, const Xml::Element& element, int minor) {
  const Xml::Element* sdf = &element;
  while (sdf->Name() != std::string("sdf") && sdf->Parent()->ToElement()) {
    sdf = sdf->Parent()->ToElement();
  }
  const char* version = sdf->Attribute("version");
  if (!version) return true;
  const std::string text = trimmed(version);
  const std::size_t dot = std::min(text.find('.'), text.size());
  const auto major = parse_number(text.substr(0, dot));
  const auto after = parse_number(dot < text.size() ? text.substr(dot + 1) : "0");
  if (!major || !after) {
    xml.fail(*sdf, "version of <sdf> is '" + text + "'. Write a version, such as 1.6.");
  }
  return *major < 1 || (*major == 1 && *after <= minor);
}

}  // namespace quadcore
