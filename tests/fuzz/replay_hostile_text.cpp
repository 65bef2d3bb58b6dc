// Checks every model and world in the folders given as the fuzz target does.
#include <cstdio>
#include <exception>
#include <filesystem>

#include "hostile_text.hpp"
#include "quadcore/plugin/document.hpp"

int main(int count, char** folders) {
  int files = 0, failures = 0;
  for (int i = 1; i < count; ++i) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folders[i])) {
      const std::filesystem::path& path = entry.path();
      if (path.extension() != ".urdf" && path.extension() != ".world") continue;
      ++files;
      try {
        check_hostile_text(quadcore::Document::read(path.string()).text);
      } catch (const std::exception& error) {
        ++failures;
        std::printf("%s: %s\n", path.c_str(), error.what());
      }
    }
  }
  std::printf("%d files, %d failures\n", files, failures);
  return failures || !files ? 1 : 0;
}
