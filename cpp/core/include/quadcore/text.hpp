#pragma once

#include <optional>
#include <string>
#include <vector>

#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/spatial.hpp"

/// \file
/// Strict reading and writing of numbers and names, independent of the locale.

namespace quadcore QUADCORE_EXPORT {

/// Return the finite number in a text with nothing else except surrounding blanks.
std::optional<double> parse_number(const std::string& text);
/// Return exactly three finite numbers, separated by blanks.
std::optional<Vector3d> parse_vector(const std::string& text);
/// Return a text without surrounding white space.
std::string trimmed(const std::string& text);
/// Return a text with ASCII capitals converted to lower case.
std::string lower(std::string text);
/// Return the words of a text, separated by white space.
std::vector<std::string> split(const std::string& text);

/// Return the size in bytes of the well-formed UTF-8 character at `at`, or 0 if there is none.
std::size_t character_size(const std::string& text, std::size_t at);

/// Return " Did you mean 'x'?" for the candidate nearest to `name`, or "" if none is close.
std::string suggest(const std::string& name, const std::vector<std::string>& candidates);
/// Return whether two names differ in only a few letters.
bool is_similar(const std::string& a, const std::string& b);
/// Format a time, such as "1.250000 s", independent of the locale.
std::string seconds(double time);
/// Return a number rounded to so many significant digits, at most 17.
double with_digits(double number, int digits);
/// Append a number with the fewest digits that read back exactly, in the layout of printf's %.17g.
void append_shortest(double number, std::string& text);
/// Join names as "a, b, c".
std::string joined(const std::vector<std::string>& names);

}  // namespace quadcore
