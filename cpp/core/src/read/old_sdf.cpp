#include "old_sdf.hpp"

#include <map>
#include <set>

namespace quadcore {
namespace {

using Names = std::pair<std::string, std::string>;

/// Attributes that are the whole value of their element.
const std::set<Names> values = {
    {"origin", "pose"}, {"gravity", "xyz"}, {"parent", "link"}, {"child", "link"}};
/// Elements and attributes with another name.
const std::map<std::string, std::string> new_names = {{old_sdf_root, "sdf"}, {"origin", "pose"}};
const std::map<Names, std::string> new_attribute_names = {{{"mesh", "filename"}, "uri"}};
/// Attributes that stay.
const std::set<std::string> kept = {"name", "type", "version", "filename", "default"};

}  // namespace

NewElement convert_element(const Xml::Element& element, bool is_old) {
  NewElement result;
  const std::string name = element.Name();
  const auto renamed = new_names.find(name);
  result.name = is_old && renamed != new_names.end() ? renamed->second : name;
  for (const auto* a = element.FirstAttribute(); a; a = a->Next()) {
    const Names names = {name, a->Name()};
    const auto new_name = new_attribute_names.find(names);
    if (is_old && values.count(names)) {
      result.text = a->Value();
    } else if (is_old && new_name != new_attribute_names.end()) {
      result.children.emplace_back(new_name->second, a->Value());
    } else if (!is_old || kept.count(names.second)) {
      result.attributes.emplace_back(names.second, a->Value());
    } else {
      result.children.emplace_back(names.second, a->Value());
    }
  }
  return result;
}

}  // namespace quadcore
