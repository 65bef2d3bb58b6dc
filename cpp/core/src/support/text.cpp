#include "quadcore/text.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <locale>
#include <numeric>
#include <sstream>

namespace quadcore {

std::optional<double> parse_number(const std::string& text) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  double value;
  if (!(stream >> value) || !std::isfinite(value)) return std::nullopt;
  if (!(stream >> std::ws).eof()) return std::nullopt;
  return value;
}

std::optional<Vector3d> parse_vector(const std::string& text) {
  const std::vector<std::string> words = split(text);
  if (words.size() != 3) return std::nullopt;
  Vector3d vector;
  for (int i = 0; i < 3; ++i) {
    const auto value = parse_number(words[static_cast<std::size_t>(i)]);
    if (!value) return std::nullopt;
    vector[i] = *value;
  }
  return vector;
}

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::string trimmed(const std::string& text) {
  const char* blanks = " \t\r\n";
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::vector<std::string> split(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

std::size_t character_size(const std::string& text, std::size_t at) {
  const auto byte = [&](std::size_t i) -> unsigned {
    return at + i < text.size() ? static_cast<unsigned char>(text[at + i]) : 0;
  };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  // The first byte (Unicode 15, table 3-7) fixes the number of bytes and the range of the second.
  const std::size_t size = first < 0xC2   ? 0
                           : first < 0xE0 ? 2
                           : first < 0xF0 ? 3
                           : first < 0xF5 ? 4
                                          : 0;
  const unsigned low = first == 0xE0 ? 0xA0 : first == 0xF0 ? 0x90 : 0x80;
  const unsigned high = first == 0xED ? 0x9F : first == 0xF4 ? 0x8F : 0xBF;
  if (size == 0 || byte(1) < low || byte(1) > high) return 0;
  for (std::size_t i = 2; i < size; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
  }
  return size;
}

namespace {

/// Longer names are not compared: the cost is the product of the two lengths.
constexpr std::size_t longest_misspelling = 64;

/// Levenshtein distance, suggest_ignoring case.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const bool same = std::tolower(static_cast<unsigned char>(a[i])) ==
                        std::tolower(static_cast<unsigned char>(b[j]));
      const std::size_t substituted = diagonal + (same ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({substituted, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string suggest(const std::string& name, const std::vector<std::string>& candidates) {
  if (name.size() > longest_misspelling) return "";
  const std::string* nearest = nullptr;
  std::size_t least = name.size() / 4 + 2;
  for (const std::string& candidate : candidates) {
    if (candidate.size() > longest_misspelling) continue;
    const bool is_beginning = name.size() > 2 && lower(candidate).rfind(lower(name), 0) == 0;
    const std::size_t distance = is_beginning ? 0 : edit_distance(name, candidate);
    if (distance < least) {
      least = distance;
      nearest = &candidate;
    }
  }
  return nearest ? " Did you mean '" + *nearest + "'?" : "";
}

bool is_similar(const std::string& a, const std::string& b) {
  if (std::max(a.size(), b.size()) > longest_misspelling) return false;
  return edit_distance(a, b) <= std::max(a.size(), b.size()) / 5;
}

std::string seconds(double time) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::fixed << time << " s";
  return text.str();
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "none" : text;
}

}  // namespace quadcore
