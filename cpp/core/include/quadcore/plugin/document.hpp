#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "quadcore/plugin/export.hpp"

namespace quadcore QUADCORE_EXPORT {

/// An XML text and the origin of its lines. An expanded document (xacro) has the source file and
/// line of each of its lines; otherwise the text is the file itself.
struct Document {
  /// \name Limits, far beyond any model or world
  /// @{
  static constexpr std::size_t largest = 1000000;         ///< bytes of a model
  static constexpr std::size_t largest_world = 10000000;  ///< bytes of a world
  static constexpr int most_levels = 64;                  ///< nesting depth of elements
  static constexpr int most_attributes = 100;             ///< attributes of one element
  /// @}

  std::string name;  ///< file name for error messages
  std::string text;  ///< XML text
  /// Source file and line of each line of an expanded text; empty if the text is the file.
  std::vector<std::pair<std::string, int>> lines = {};

  /// Return "FILE:LINE" of a line of the text, counted from 1.
  std::string at(int line) const;
  /// Read a file. Throws InputError like read_text_file().
  static Document read(const std::string& path);
};

/// Everything needed to read a model or a world again.
struct Source {
  Document document;                ///< document as given
  std::vector<std::string> ignore;  ///< see IgnoredElements
};

}  // namespace quadcore
