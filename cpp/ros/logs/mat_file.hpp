#pragma once

#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

/// \file
/// Files of MATLAB, version 5 (MAT-File Format, MathWorks R2019b, chapter 1), little-endian and not
/// compressed.

namespace quadcore::node {

/// A column of numbers: its name, and the number of a row.
struct MatVector {
  std::string name;
  std::function<double(std::size_t)> at;
};

/// Writes variables one after another.
class MatFile {
 public:
  /// Writes the head of a file. Failures are to be asked of the file.
  explicit MatFile(std::FILE* file);
  /// A column vector of so many rows.
  void vector(const MatVector& vector, std::size_t rows);
  /// A struct of column vectors.
  /// Throws InputError if it is larger than a file of this version can hold.
  void structure(const std::string& name, const std::vector<MatVector>& fields, std::size_t rows);
  /// A column cell array of texts.
  void texts(const std::string& name, const std::vector<std::string>& texts);

 private:
  void write(const std::string& bytes) { std::fwrite(bytes.data(), 1, bytes.size(), file_); }

  std::FILE* const file_;
};

}  // namespace quadcore::node
