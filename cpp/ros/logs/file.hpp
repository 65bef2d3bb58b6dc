#pragma once

#include <cstdio>
#include <memory>

namespace quadcore::node {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
/// An open file, closed with its owner.
using File = std::unique_ptr<std::FILE, CloseFile>;

}  // namespace quadcore::node
