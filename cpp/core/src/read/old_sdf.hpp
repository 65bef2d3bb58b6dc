#pragma once

#include <string>
#include <utility>
#include <vector>

#include "xml.hpp"

namespace quadcore {

/// Outermost element of SDF 1.0 to 1.2, which Gazebo 11 refuses.
constexpr const char* old_sdf_root = "gazebo";

/// An element of SDF 1.0 in the form of SDF 1.3, in which most attributes are elements.
struct NewElement {
  std::string name;
  std::vector<std::pair<std::string, std::string>> attributes, children;  ///< name and value
  std::string text;
};

/// Convert an element without its content as sdformat's 1_0.convert and 1_2.convert do.
/// \param is_old  whether the document is older than SDF 1.3; otherwise nothing changes
NewElement convert_element(const Xml::Element& element, bool is_old);

}  // namespace quadcore
