#pragma once

#include <cstddef>
#include <string>

#include "quadcore/plugin/export.hpp"

namespace quadcore QUADCORE_EXPORT {

/// Read a file given by the user, without its byte-order mark. Throws InputError if it cannot be
/// read, is empty or too large, or is not a regular file, because a pipe could block forever.
///
/// \param path      path of the file
/// \param largest   maximum size in bytes; the default exceeds any handwritten file
std::string read_text_file(const std::string& path, std::size_t largest = 100000000);

}  // namespace quadcore
