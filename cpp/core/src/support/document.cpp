#include "quadcore/plugin/document.hpp"

#include "quadcore/text_file.hpp"

namespace quadcore {

std::string Document::at(int line) const {
  if (line >= 1 && static_cast<std::size_t>(line) <= lines.size()) {
    const auto& [file, number] = lines[static_cast<std::size_t>(line) - 1];
    return file + ":" + std::to_string(number);
  }
  return name + ":" + std::to_string(line);
}

Document Document::read(const std::string& path) {
  return {path, read_text_file(path, largest_world)};
}

}  // namespace quadcore
