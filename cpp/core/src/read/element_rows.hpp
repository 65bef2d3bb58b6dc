#pragma once

#include <cmath>
#include <functional>
#include <string>

#include "quadcore/plugin/spatial.hpp"
#include "quadcore/plugin/tags.hpp"
#include "xml.hpp"

namespace quadcore {

/// An element of a document, named by its path below another element. An element without a meaning
/// is an alternative name or only groups other elements.
struct ElementRow {
  TagSpec spec;
  std::function<void(const Xml::Element&)> read;
};

/// Makes rows that read the text of an element into a variable, and skips elements. An empty
/// element leaves the variable at its default, as in Gazebo.
class ElementRows {
 public:
  struct Range {
    double min = -INFINITY, max = INFINITY;
    bool open = false;  ///< excludes min itself
  };
  static Range above(double min, double max = INFINITY) { return {min, max, true}; }

  /// The document must outlive this object, and this object its rows.
  explicit ElementRows(const Xml& xml) : xml_(xml) {}

  ElementRow number(std::string path, std::string unit, double& target, const Range& range,
                    std::string meaning) const;
  ElementRow vector(std::string path, std::string unit, Vector3d& target,
                    std::string meaning) const;
  /// Make a row that checks the text against the choices of a tag.
  ElementRow word(const TagSpec& spec) const;
  /// Make a row for an element without a value to show in the table.
  static ElementRow other(std::string path, std::string meaning,
                          std::function<void(const Xml::Element&)> read);

  /// Return whether an element contains no text, and record that.
  bool is_empty(const Xml::Element& e) const;
  /// Record an element without effect.
  void skip(const Xml::Element& e, const std::string& what) const;
  /// Record an element that only has an effect elsewhere.
  void skip_here(const Xml::Element& e) const;

 private:
  const Xml& xml_;
};

}  // namespace quadcore
