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
  /// What is opened need not be what was looked at: opening a pipe waits for a writer.
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
  if (S_ISDIR(status.st_mode)) throw InputError(path + ": is a folder; name a file in it");
  if (!S_ISREG(status.st_mode)) {
    throw InputError(path + ": is no regular file; save what it gives in one");
  }
}

}  // namespace

std::string read_text_file(const std::string& path, std::size_t largest) {
  struct stat status;
  if (::stat(path.c_str(), &status) == 0) check_regular(path, status);
  const Descriptor file(path);
  if (::fstat(file, &status) != 0) {
    throw InputError(path + ": cannot be read; give the path of an existing file");
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
      throw InputError(path + ": is larger than " + megabytes.str() + " MB, the most that is read");
    }
  }
  if (text.empty()) throw InputError(path + ": is empty; give another file");
  constexpr const char* byte_order_mark = "\xEF\xBB\xBF";
  if (text.compare(0, 3, byte_order_mark) == 0) text.erase(0, 3);
  return text;
}

}  // namespace quadcore
