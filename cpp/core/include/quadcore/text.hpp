#pragma once

#include <optional>
#include <string>
#include <vector>

#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/spatial.hpp"

/// \file
/// Reading and writing numbers and names strictly, whatever the locale.

namespace quadcore QUADCORE_EXPORT {

/// A finite number and nothing else; blanks around it are allowed.
std::optional<double> parse_number(const std::string& text);
/// Exactly three finite numbers, separated by blanks.
std::optional<Vector3d> parse_vector(const std::string& text);
/// A text without the blanks and ends of lines around it.
std::string trimmed(const std::string& text);
/// With small letters of ASCII in place of capitals.
std::string lower(std::string text);
/// The words of a text, between blanks and ends of lines.
std::vector<std::string> split(const std::string& text);

/// Bytes of the well-formed UTF-8 character that begins at `at`, or 0 if none does.
std::size_t character_size(const std::string& text, std::size_t at);

/// " (did you mean 'x'?)" for the candidate nearest to `name`, or "" if none is near.
std::string did_you_mean(const std::string& name, const std::vector<std::string>& candidates);
/// Whether two names differ in a few letters only.
bool is_slip(const std::string& a, const std::string& b);
/// "1.250000 s", which std::to_string would write with a comma in some locales.
std::string seconds(double time);
/// What comes back of a number that is written with so many significant digits, 17 at most.
double with_digits(double number, int digits);
/// Appends a number with the fewest digits that read back exactly, laid out as by printf's %.17g.
void append_shortest(double number, std::string& text);
/// "a, b, c"
std::string joined(const std::vector<std::string>& names);

}  // namespace quadcore
