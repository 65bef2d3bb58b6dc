#include "control/files/text_file.hpp"

#include <fstream>

#include "quadcore/error.hpp"

namespace quadcore::control {
namespace {

constexpr std::size_t largest = 100000000;  ///< bytes

}  // namespace

std::string read_text_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text, piece(1 << 16, '\0');
  while (file.read(piece.data(), static_cast<std::streamsize>(piece.size())), file.gcount() > 0) {
    text.append(piece, 0, static_cast<std::size_t>(file.gcount()));
    if (text.size() > largest) {
      throw InputError(path + ": is larger than 100 MB, the most that is read");
    }
  }
  if (text.empty()) {
    throw InputError(path + ": cannot be read; give the path of an existing, non-empty file");
  }
  constexpr const char* byte_order_mark = "\xEF\xBB\xBF";
  if (text.compare(0, 3, byte_order_mark) == 0) text.erase(0, 3);
  return text;
}

}  // namespace quadcore::control
