#include <doctest/doctest.h>

#include <limits>

#include "quadcore/commands.hpp"
#include "vehicle.hpp"

using namespace quadcore;
using namespace quadcore::test;

namespace {

Commands::Table table() {
  Commands::Table rows(3, 3);
  rows << 0.0, 1, 2,  //
      0.1, 3, 4,      //
      0.2, 5, 6;
  return rows;
}

}  // namespace

TEST_CASE("a row holds from its time, less a nanosecond, until the next") {
  Commands commands(table(), 2);
  CHECK(commands.at(0)[0] == 1);
  CHECK(commands.at(0.0999)[1] == 2);
  CHECK(commands.at(0.1 - 2e-9)[0] == 1);
  CHECK(commands.at(0.1 - 0.5e-9)[0] == 3);
  CHECK(commands.at(0.1)[1] == 4);
  CHECK(commands.at(1e9)[1] == 6);
}

TEST_CASE("before the first row there is no command") {
  Commands commands(table(), 2);
  CHECK(commands.at(-1e-8) == nullptr);
  CHECK(commands.at(-0.5e-9) != nullptr);
}

TEST_CASE("any time may be asked for after any other") {
  Commands commands(table(), 2);
  CHECK(commands.at(5)[0] == 5);
  CHECK(commands.at(0.15)[0] == 3);
  CHECK(commands.at(-1) == nullptr);
  CHECK(commands.at(0.25)[0] == 5);
  CHECK(commands.at(0)[0] == 1);
}

TEST_CASE("tables that are none are refused") {
  const auto refused = [](const Commands::Table& rows, std::size_t width) {
    return refusal([&] { Commands(rows, width); });
  };
  CHECK(contains(refused(table(), 3), "Write rows of time and 3 rotor speeds"));
  CHECK(contains(refused(Commands::Table(0, 3), 2), "0 rows"));
  CHECK(contains(Commands::fault(Commands::Table(3, 0))->what, "there is no time"));
  CHECK(!Commands::fault(Commands::Table(0, 0)));
  Commands::Table rows = table();
  rows(1, 0) = 0;
  CHECK(contains(refused(rows, 2), "row 1: t = 0 is not later than 0"));
  rows(1, 0) = std::numeric_limits<double>::quiet_NaN();
  CHECK(contains(refused(rows, 2), "row 1: t is nan. Write a finite number"));
  rows = table();
  rows(2, 2) = -std::numeric_limits<double>::infinity();
  CHECK(contains(refused(rows, 2), "row 2: w2 is -inf. Write a finite number"));
}

TEST_CASE(
    "a command is as many finite numbers as there are rotors, none too fast if that is asked") {
  const double speeds[] = {400, -2e6};
  check_command(speeds, 2, 2);
  check_command(speeds, 1, 1, 1e6);
  CHECK(refusal([&] { check_command(speeds, 2, 3); }) == "the command has 2 rotor speeds. Give 3.");
  CHECK(refusal([&] { check_command(speeds, 2, 2, 1e6); }) ==
        "the command for rotor 2 is beyond 1e+06 rad/s, the limit at which a flight counts as "
        "diverged. Give a speed in rad/s.");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(refusal([&] { check_command(&nan, 1, 1); }) ==
        "the command for rotor 1 is not a finite number. Give a speed in rad/s.");
}
