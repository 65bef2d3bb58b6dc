#pragma once

#include <tinyxml2.h>

#include <set>
#include <string>
#include <vector>

#include "quadcore/plugin/document.hpp"
#include "quadcore/plugin/ignored_elements.hpp"
#include "quadcore/plugin/spatial.hpp"

namespace quadcore {

/// An XML document that is read strictly: every error gives FILE:LINE and the remedy. Elements that
/// have no effect on the motion, and those that the user ignores, are recorded as IgnoredElements.
class Xml {
 public:
  using Element = tinyxml2::XMLElement;

  /// Parse the document and check the name of its root element.
  /// \param old_name  another accepted name, or ""
  Xml(const Document& document, const std::string& root_name, IgnoredElements& ignored_elements,
      const std::string& old_name = "");

  const Element& root() const { return *xml_.RootElement(); }
  std::string where(const Element& element) const { return document_.at(element.GetLineNum()); }
  [[noreturn]] void fail(const Element& element, const std::string& what) const;

  IgnoredElements& ignored_elements() const { return ignored_elements_; }

  /// Return the child elements named in `allowed`. Only those in `repeatable` may repeat. Any other
  /// child is an error unless it may be skipped.
  std::vector<const Element*> children(const Element& element, const std::set<std::string>& allowed,
                                       const std::set<std::string>& repeatable = {}) const;
  /// Return the first child with that name, or null.
  const Element* child(const Element& element, const char* name) const {
    return element.FirstChildElement(name);
  }
  const Element& required_child(const Element& element, const char* name) const;

  /// Reject any attribute outside `allowed`. Attributes with a namespace prefix are skipped.
  void only_attributes(const Element& element, const std::set<std::string>& allowed) const;
  /// Reject any attribute outside `allowed` and any content.
  void attributes_alone(const Element& element, const std::set<std::string>& allowed) const;
  std::string attribute(const Element& element, const char* name) const;
  double number(const Element& element, const char* attribute) const;
  double number(const Element& element, const char* attribute, double fallback) const;
  Vector3d vector(const Element& element, const char* attribute, const Vector3d& fallback) const;
  /// Return the trimmed text of an element that may contain nothing else.
  std::string text(const Element& element, const std::set<std::string>& attributes = {}) const;
  double number_in_text(const Element& element) const;
  Vector3d vector_in_text(const Element& element) const;

 private:
  void check_size(const Element& element, const std::string& what, double value) const;
  double as_number(const Element& element, const std::string& what, const std::string& text) const;
  Vector3d as_vector(const Element& element, const std::string& what,
                     const std::string& text) const;

  /// Return the element's path in the form that effect_of_element() expects.
  std::string path(const Element& element) const;
  /// Skip a child that is not read, or fail if it may not be skipped.
  void skip_or_fail(const Element& parent, const Element& child,
                    const std::set<std::string>& allowed) const;

  const Document& document_;
  IgnoredElements& ignored_elements_;
  tinyxml2::XMLDocument xml_;
};

}  // namespace quadcore
