#pragma once

#include <tinyxml2.h>

#include <set>
#include <string>
#include <vector>

#include "quadcore/plugin/document.hpp"
#include "quadcore/plugin/passed_over.hpp"
#include "quadcore/plugin/spatial.hpp"

namespace quadcore {

/// An XML document read strictly: every error names FILE:LINE and what to write instead. What is
/// neither read nor felt, and what the user wants left out, goes to a PassedOver.
class Xml {
 public:
  using Element = tinyxml2::XMLElement;

  /// Parses the document and checks the name of its root element.
  Xml(const Document& document, const std::string& root_name, PassedOver& passed_over);

  const Element& root() const { return *xml_.RootElement(); }
  std::string where(const Element& element) const { return document_.at(element.GetLineNum()); }
  [[noreturn]] void fail(const Element& element, const std::string& what) const;

  PassedOver& passed_over() const { return passed_over_; }

  /// The child elements named in `allowed`, those outside `repeatable` once at most; another fails
  /// unless it may be passed over.
  std::vector<const Element*> children(const Element& element, const std::set<std::string>& allowed,
                                       const std::set<std::string>& repeatable = {}) const;
  /// The child of that name, or null.
  const Element* child(const Element& element, const char* name) const {
    return element.FirstChildElement(name);
  }
  const Element& required_child(const Element& element, const char* name) const;

  /// Refuses an attribute outside `allowed`; one with a prefix is another vocabulary's.
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

  /// As verdict_on_element() takes it.
  std::string path(const Element& element) const;
  /// Fails at a child that is not read, unless it may be passed over.
  void pass_over(const Element& parent, const Element& child,
                 const std::set<std::string>& allowed) const;

  const Document& document_;
  PassedOver& passed_over_;
  tinyxml2::XMLDocument xml_;
};

}  // namespace quadcore
