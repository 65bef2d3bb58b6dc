#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <locale>
#include <random>

#include "quadcore/text.hpp"

using namespace quadcore;

TEST_CASE("a number is read whole or not at all") {
  CHECK(parse_number("1.5") == 1.5);
  CHECK(parse_number(" -2e-3\n") == -2e-3);
  CHECK(parse_number("+7") == 7);
  CHECK(parse_number("0.1") == 0.1);
  for (const char* text : {"", " ", "nan", "NaN", "inf", "-inf", "infinity", "1e999", "1,5", "1kg",
                           "1 2", "0x10", "one", "1e", "--1", "1.2.3"}) {
    CAPTURE(text);
    CHECK_FALSE(parse_number(text).has_value());
  }
}

TEST_CASE("numbers are read alike in every locale") {
  struct Comma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  const std::locale before = std::locale::global(std::locale(std::locale(), new Comma));
  const auto value = parse_number("1.5");
  const auto foreign = parse_number("1,5");
  std::locale::global(before);
  CHECK(value == 1.5);
  CHECK_FALSE(foreign.has_value());
}

TEST_CASE("a vector has three numbers") {
  CHECK(parse_vector(" 1\t-2\n3e-1 ") == Vector3d(1, -2, 0.3));
  for (const char* text : {"", "1 2", "1 2 3 4", "1 2 x", "1, 2, 3", "1 2 nan"}) {
    CAPTURE(text);
    CHECK_FALSE(parse_vector(text).has_value());
  }
}

TEST_CASE("blanks around and between words do not matter") {
  CHECK(trimmed(" \t a b\r\n") == "a b");
  CHECK(trimmed(" \n") == "");
  CHECK(split(" a  b\nc ") == std::vector<std::string>{"a", "b", "c"});
  CHECK(split(" ").empty());
  CHECK(joined({"a", "b"}) == "a, b");
  CHECK(joined({}) == "none");
}

TEST_CASE("the nearest name is proposed, and none that is far") {
  const std::vector<std::string> names = {"kp", "ki", "sim_slow", "rotorThrustCoeff"};
  CHECK(suggest("simslow", names) == " Did you mean 'sim_slow'?");
  CHECK(suggest("SIM_SLOW", names) == " Did you mean 'sim_slow'?");
  CHECK(suggest("rotorTrustCoef", names) == " Did you mean 'rotorThrustCoeff'?");
  CHECK(suggest("kI", names) == " Did you mean 'ki'?");
  CHECK(suggest("propeller", names) == "");
  CHECK(suggest("x", {}) == "");
}

namespace {

std::string shortest(double number) {
  std::string text;
  append_shortest(number, text);
  return text;
}

/// Digits without sign, point, exponent, and the zeros around them.
std::size_t digits_of(const std::string& text) {
  std::size_t count = 0, zeros = 0;
  for (const char c : text.substr(0, text.find('e'))) {
    if (c < '0' || c > '9') continue;
    zeros = c == '0' ? zeros + (count > 0) : 0;
    count += c != '0' || count > 0;
  }
  return count - zeros;
}

}  // namespace

TEST_CASE("numbers are written with the fewest digits that restore every bit") {
  CHECK(shortest(0) == "0");
  CHECK(shortest(-0.0) == "-0");
  CHECK(shortest(0.001) == "0.001");
  CHECK(shortest(-480) == "-480");
  CHECK(shortest(0.1 + 0.2) == "0.30000000000000004");
  CHECK(shortest(1.0 / 3) == "0.3333333333333333");
  CHECK(shortest(0.00012) == "0.00012");
  CHECK(shortest(0.000012) == "1.2e-05");
  CHECK(shortest(12345678.25) == "12345678.25");
  CHECK(shortest(1e16) == "10000000000000000");
  CHECK(shortest(1e17) == "1e+17");
  CHECK(shortest(std::numeric_limits<double>::max()) == "1.7976931348623157e+308");
  CHECK(shortest(std::numeric_limits<double>::denorm_min()) == "5e-324");
  CHECK(shortest(std::nan("")) == "nan");
  CHECK(shortest(-INFINITY) == "-inf");
  std::mt19937_64 random(1);
  for (int i = 0; i < 20000; ++i) {
    const std::uint64_t bits = random();
    double number = i % 2 ? static_cast<double>(bits) * 0x1p-60 : 0;  // of daily size, and of any
    if (i % 2 == 0) std::memcpy(&number, &bits, sizeof number);
    if (!std::isfinite(number)) continue;
    const std::string text = shortest(number);
    CAPTURE(text);
    const double back = std::strtod(text.c_str(), nullptr);
    CHECK(std::memcmp(&back, &number, sizeof number) == 0);
    char fewer[32];
    const int one_less = static_cast<int>(digits_of(text)) - 1;
    if (one_less < 1) continue;
    std::snprintf(fewer, sizeof fewer, "%.*e", one_less - 1, number);
    CHECK(std::strtod(fewer, nullptr) != number);
  }
}

TEST_CASE("a number comes back of so many digits as printf would have written it") {
  CHECK(with_digits(1.0 / 3, 6) == 0.333333);
  CHECK(with_digits(0.1 + 0.2, 16) == 0.3);
  CHECK(with_digits(0.1 + 0.2, 17) == 0.1 + 0.2);
  CHECK(with_digits(-1234567.8, 6) == -1234570);
  CHECK(with_digits(0.5e-10 / 3, 3) == 1.67e-11);
  CHECK(with_digits(0, 6) == 0);
}
