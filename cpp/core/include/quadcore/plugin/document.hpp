#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "quadcore/plugin/export.hpp"

namespace quadcore QUADCORE_EXPORT {

/// An XML text and where its lines came from. A document that was expanded (by xacro) carries for
/// each of its lines the file and line it stems from; otherwise the text is the file itself.
struct Document {
  /// \name Limits, far beyond any model or world
  /// @{
  static constexpr std::size_t largest = 1000000;  ///< bytes
  static constexpr int most_levels = 64;           ///< of elements in each other
  static constexpr int most_attributes = 100;      ///< of one element
  /// @}

  std::string name;  ///< of the file, for errors
  std::string text;  ///< the XML
  /// File and line that each line of an expanded text stems from; empty if the text is the file.
  std::vector<std::pair<std::string, int>> lines = {};

  /// "FILE:LINE" of a line of the text, counted from 1.
  std::string at(int line) const;
  /// Reads a file; throws InputError as read_text_file() does.
  static Document read(const std::string& path);
};

/// All that a model or a world was read from, so that it can be read again anywhere.
struct Source {
  Document document;                ///< as it was given
  std::vector<std::string> ignore;  ///< see PassedOver
};

}  // namespace quadcore
