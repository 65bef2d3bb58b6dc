#pragma once

#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

/// \file
/// MATLAB 5 files (MAT-File Format, MathWorks R2019b, chapter 1), little-endian and not compressed.

namespace quadcore::node {

/// A column of numbers: its name, and a function that returns the number of a row.
struct MatVector {
  std::string name;
  std::function<double(std::size_t)> at;
};

/// Writes variables one after another.
class MatFile {
 public:
  /// Writes the header of a file. Check the file for errors.
  explicit MatFile(std::FILE* file);
  /// Writes a column vector.
  void write_vector(const MatVector& vector, std::size_t rows);
  /// Writes a struct of column vectors. Throws InputError if it is too large for this version.
  void write_structure(const std::string& name, const std::vector<MatVector>& fields,
                       std::size_t rows);
  /// Writes a column cell array of texts.
  void write_texts(const std::string& name, const std::vector<std::string>& texts);

 private:
  void write(const std::string& bytes) { std::fwrite(bytes.data(), 1, bytes.size(), file_); }

  std::FILE* const file_;
};

}  // namespace quadcore::node
