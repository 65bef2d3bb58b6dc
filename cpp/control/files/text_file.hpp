#pragma once

#include <string>

namespace quadcore::control {

/// A whole file. Throws InputError if it cannot be read, or is larger than any that people write.
std::string read_text_file(const std::string& path);

}  // namespace quadcore::control
