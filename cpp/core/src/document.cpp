#include "quadcore/document.hpp"

#include <fstream>
#include <sstream>

#include "quadcore/error.hpp"

namespace quadcore {

std::string Document::at(int line) const {
  if (line >= 1 && static_cast<std::size_t>(line) <= lines.size()) {
    const auto& [file, number] = lines[static_cast<std::size_t>(line) - 1];
    return file + ":" + std::to_string(number);
  }
  return name + ":" + std::to_string(line);
}

Document Document::read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (!(file && text << file.rdbuf())) {
    throw InputError(path + ": cannot be read; give the path of an existing, non-empty file");
  }
  return {path, text.str()};
}

}  // namespace quadcore
