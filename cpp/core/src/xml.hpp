#pragma once

#include <tinyxml2.h>

#include <set>
#include <string>
#include <vector>

#include "quadcore/document.hpp"
#include "quadcore/spatial.hpp"

namespace quadcore {

/// An XML document read strictly: every error names FILE:LINE and what to write instead.
class Xml {
 public:
  using Element = tinyxml2::XMLElement;

  /// Parses the document and checks the name of its root element.
  Xml(const Document& document, const std::string& root_name);

  const Element& root() const { return *xml_.RootElement(); }
  std::string where(const Element& element) const { return document_.at(element.GetLineNum()); }
  [[noreturn]] void fail(const Element& element, const std::string& what) const;

  /// The child elements; a name outside `allowed`, or one outside `repeatable` given twice, fails.
  std::vector<const Element*> children(const Element& element, const std::set<std::string>& allowed,
                                       const std::set<std::string>& repeatable = {}) const;
  /// The child of that name, or null.
  const Element* child(const Element& element, const char* name) const {
    return element.FirstChildElement(name);
  }
  const Element& required_child(const Element& element, const char* name) const;

  /// Refuses an attribute outside `allowed`; namespace declarations are always allowed.
  void only_attributes(const Element& element, const std::set<std::string>& allowed) const;
  /// Refuses the same, and anything within the element.
  void attributes_alone(const Element& element, const std::set<std::string>& allowed) const;
  std::string attribute(const Element& element, const char* name) const;
  double number(const Element& element, const char* attribute) const;
  double number(const Element& element, const char* attribute, double fallback) const;
  Vector3d vector(const Element& element, const char* attribute, const Vector3d& fallback) const;
  /// The text, trimmed, of an element that may hold nothing else.
  std::string text(const Element& element) const;
  double number_in_text(const Element& element) const;
  Vector3d vector_in_text(const Element& element) const;

 private:
  void check_size(const Element& element, const std::string& what, double value) const;
  double as_number(const Element& element, const std::string& what, const std::string& text) const;
  Vector3d as_vector(const Element& element, const std::string& what,
                     const std::string& text) const;

  const Document& document_;
  tinyxml2::XMLDocument xml_;
};

}  // namespace quadcore
