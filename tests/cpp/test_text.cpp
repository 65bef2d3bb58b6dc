#include <doctest/doctest.h>

#include <locale>

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
  CHECK(did_you_mean("simslow", names) == " (did you mean 'sim_slow'?)");
  CHECK(did_you_mean("SIM_SLOW", names) == " (did you mean 'sim_slow'?)");
  CHECK(did_you_mean("rotorTrustCoef", names) == " (did you mean 'rotorThrustCoeff'?)");
  CHECK(did_you_mean("kI", names) == " (did you mean 'ki'?)");
  CHECK(did_you_mean("propeller", names) == "");
  CHECK(did_you_mean("x", {}) == "");
}
