#include "quadcore/text_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <locale>
#include <sstream>

#include "quadcore/plugin/error.hpp"

namespace quadcore {
namespace {

/// An open file, or none if the system refused it.
class Descriptor {
 public:
  /// The path may have changed since it was examined, and opening a pipe would wait for a writer.
  explicit Descriptor(const std::string& path)
      : number_(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  operator int() const { return number_; }

 private:
  int number_;
};

void check_regular(const std::string& path, const struct stat& status) {
  if (S_ISDIR(status.st_mode)) throw InputError(path + ": this is a folder. Name a file in it.");
  if (!S_ISREG(status.st_mode)) {
    throw InputError(path + ": this is not a regular file. Save its content in a regular file.");
  }
}

}  // namespace

std::string read_text_file(const std::string& path, std::size_t largest) {
  struct stat status;
  if (::stat(path.c_str(), &status) == 0) check_regular(path, status);
  const Descriptor file(path);
  if (::fstat(file, &status) != 0) {
    throw InputError(path +
                     ": the file cannot be read. Give the path of an existing, readable file.");
  }
  check_regular(path, status);

  std::string text, piece(1 << 16, '\0');
  for (;;) {
    const ::ssize_t count = ::read(file, piece.data(), piece.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    text.append(piece, 0, static_cast<std::size_t>(count));
    if (text.size() > largest) {
      std::ostringstream megabytes;
      megabytes.imbue(std::locale::classic());
      megabytes << static_cast<double>(largest) / 1e6;
      throw InputError(path + ": the file exceeds the limit of " + megabytes.str() +
                       " MB. Use a smaller file.");
    }
  }
  if (text.empty()) throw InputError(path + ": the file is empty. Give another file.");
  constexpr const char* byte_order_mark = "\xEF\xBB\xBF";
  if (text.compare(0, 3, byte_order_mark) == 0) text.erase(0, 3);
  return text;
}

}  // namespace quadcore
