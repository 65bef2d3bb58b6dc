#pragma once

#include <cstddef>
#include <string>

#include "quadcore/plugin/export.hpp"

namespace quadcore QUADCORE_EXPORT {

/// Reads a whole file that a user named, without its byte-order mark. Throws InputError if it
/// cannot be read, is empty or too large, or is no regular file: a pipe could be waited for without
/// end.
///
/// \param path      of the file
/// \param largest   bytes that it may have; by default more than any that people write
std::string read_text_file(const std::string& path, std::size_t largest = 100000000);

}  // namespace quadcore
