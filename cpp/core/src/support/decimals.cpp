#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "quadcore/text.hpp"

#ifndef __cpp_lib_to_chars
#include <locale.h>

#include <cstdio>
#endif

namespace quadcore {
namespace {

constexpr std::size_t most_digits = 17;
constexpr std::size_t longest_number = 25;  // -d.dddddddddddddddde-xxx and the terminating zero

#ifndef __cpp_lib_to_chars
/// Sets the C locale for this thread, because the program may use one with a decimal comma.
class PlainNumbers {
 public:
  PlainNumbers() : before_(uselocale(plain())) {}
  ~PlainNumbers() { uselocale(before_); }
  PlainNumbers(const PlainNumbers&) = delete;
  PlainNumbers& operator=(const PlainNumbers&) = delete;

 private:
  static locale_t plain() {
    static const locale_t locale = newlocale(LC_ALL_MASK, "C", nullptr);
    return locale;
  }
  const locale_t before_;
};
#endif

/// Write "[-]d[.ddd]e[+-]xx" with the fewest digits that read back exactly.
void write_scientific(double number, char (&text)[longest_number]) {
#ifdef __cpp_lib_to_chars
  *std::to_chars(text, text + longest_number - 1, number, std::chars_format::scientific).ptr = '\0';
#else
  // For standard libraries before GCC 11: slower, and one digit longer for some powers of two.
  const PlainNumbers plain;
  // 15 digits always read back exactly, except for subnormal numbers.
  const bool normal = number == 0 || std::abs(number) >= std::numeric_limits<double>::min();
  for (int digits = normal ? 15 : 1; digits <= 17; ++digits) {
    std::snprintf(text, longest_number, "%.*e", digits - 1, number);
    if (std::strtod(text, nullptr) == number) break;
  }
  char* const exponent = std::strchr(text, 'e');
  char* end = exponent;
  while (end[-1] == '0') --end;
  if (end[-1] == '.') --end;
  std::memmove(end, exponent, std::strlen(exponent) + 1);
#endif
}

}  // namespace

double with_digits(double number, int digits) {
  char text[longest_number];
#ifdef __cpp_lib_to_chars
  const auto written =
      std::to_chars(text, text + longest_number, number, std::chars_format::general, digits);
  std::from_chars(text, written.ptr, number);
  return number;
#else
  const PlainNumbers plain;
  std::snprintf(text, longest_number, "%.*g", digits, number);
  return std::strtod(text, nullptr);
#endif
}

void append_shortest(double number, std::string& text) {
  if (!std::isfinite(number)) {
    text += std::isnan(number) ? "nan" : number > 0 ? "inf" : "-inf";
    return;
  }
  char scientific[longest_number];
  write_scientific(number, scientific);
  const char* first = scientific;
  if (*first == '-') text += *first++;
  const char* const e = std::strchr(first, 'e');
  const int exponent = std::atoi(e + 1);
  if (exponent < -4 || exponent >= static_cast<int>(most_digits)) {  // as printf's %.17g
    text += first;
    return;
  }
  char digits[most_digits] = {*first};
  const std::size_t count = e == first + 1 ? 1 : static_cast<std::size_t>(e - first) - 1;
  std::memcpy(digits + 1, first + 2, count - 1);
  if (exponent < 0) {
    text.append("0.000", static_cast<std::size_t>(1 - exponent));
    text.append(digits, count);
    return;
  }
  const std::size_t whole = static_cast<std::size_t>(exponent) + 1;
  text.append(digits, std::min(count, whole));
  if (count > whole) {
    text += '.';
    text.append(digits + whole, count - whole);
  } else {
    text.append(whole - count, '0');
  }
}

}  // namespace quadcore
