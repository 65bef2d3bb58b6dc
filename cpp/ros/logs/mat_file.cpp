#include "mat_file.hpp"

#include <cstring>

#include "quadcore/plugin/error.hpp"

namespace quadcore::node {
namespace {

// Types of elements and classes of arrays in the format.
constexpr std::uint32_t int8 = 1, uint16 = 4, int32 = 5, uint32 = 6, real64 = 9, matrix = 14;
constexpr std::uint32_t cell_class = 1, struct_class = 2, char_class = 4, double_class = 6;
constexpr std::size_t name_room = 64;  ///< length of a field name with its end

template <class Number>
void append(std::string& bytes, Number number) {
  char raw[sizeof number];
  std::memcpy(raw, &number, sizeof number);
  bytes.append(raw, sizeof number);
}

/// Returns the tag of data with this many bytes.
std::string make_tag(std::uint32_t type, std::uint64_t size) {
  if (size > UINT32_MAX) {
    throw InputError("The flight is too long for a MATLAB 5 file. Name a .csv or .bag file.");
  }
  std::string bytes;
  append(bytes, type);
  append(bytes, static_cast<std::uint32_t>(size));
  return bytes;
}

/// Returns data with their tag; up to four bytes are part of the tag.
std::string make_element(std::uint32_t type, const std::string& data) {
  std::string bytes;
  if (!data.empty() && data.size() <= 4) {
    append(bytes, static_cast<std::uint16_t>(type));
    append(bytes, static_cast<std::uint16_t>(data.size()));
  } else {
    bytes = make_tag(type, data.size());
  }
  bytes += data;
  bytes.resize((bytes.size() + 7) / 8 * 8);
  return bytes;
}

/// Returns the start of an array.
std::string make_array_head(const std::string& name, std::uint32_t kind, std::size_t rows,
                            std::size_t columns) {
  std::string flags, dimensions;
  append(flags, kind);
  append(flags, std::uint32_t{0});
  append(dimensions, static_cast<std::int32_t>(rows));
  append(dimensions, static_cast<std::int32_t>(columns));
  return make_element(uint32, flags) + make_element(int32, dimensions) + make_element(int8, name);
}

/// Returns the bytes before the numbers of a column vector.
std::string make_vector_head(const std::string& name, std::size_t rows) {
  const std::string numbers = make_tag(real64, std::uint64_t{8} * rows);
  const std::string first = make_array_head(name, double_class, rows, 1);
  return make_tag(matrix, first.size() + numbers.size() + std::uint64_t{8} * rows) + first +
         numbers;
}

}  // namespace

MatFile::MatFile(std::FILE* file) : file_(file) {
  std::string bytes = "MATLAB 5.0 MAT-file, by quadcore";
  bytes.resize(116, ' ');
  bytes.resize(124, '\0');
  append(bytes, std::uint16_t{0x0100});
  write(bytes + "IM");
}

void MatFile::write_vector(const MatVector& vector, std::size_t rows) {
  write(make_vector_head(vector.name, rows));
  for (std::size_t i = 0; i < rows; ++i) {
    const double number = vector.at(i);
    std::fwrite(&number, sizeof number, 1, file_);
  }
}

void MatFile::write_structure(const std::string& name, const std::vector<MatVector>& fields,
                              std::size_t rows) {
  std::string room, names;
  append(room, static_cast<std::int32_t>(name_room));
  for (const MatVector& field : fields) {
    names += field.name.substr(0, name_room - 1);
    names.resize((names.size() / name_room + 1) * name_room);
  }
  const std::string first = make_array_head(name, struct_class, 1, 1) + make_element(int32, room) +
                            make_element(int8, names);
  const std::uint64_t each = make_vector_head("", rows).size() + std::uint64_t{8} * rows;
  write(make_tag(matrix, first.size() + fields.size() * each) + first);
  for (const MatVector& field : fields) write_vector({"", field.at}, rows);
}

void MatFile::write_texts(const std::string& name, const std::vector<std::string>& texts) {
  std::string bytes = make_array_head(name, cell_class, texts.size(), 1);
  for (const std::string& text : texts) {
    std::string letters;
    for (const unsigned char c : text) append(letters, std::uint16_t{c});
    bytes += make_element(
        matrix, make_array_head("", char_class, 1, text.size()) + make_element(uint16, letters));
  }
  write(make_element(matrix, bytes));
}

}  // namespace quadcore::node
