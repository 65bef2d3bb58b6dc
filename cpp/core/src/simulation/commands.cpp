#include "quadcore/commands.hpp"

#include <cmath>
#include <locale>
#include <sstream>

#include "quadcore/plugin/error.hpp"

namespace quadcore {
namespace {

/// Format a number independently of the locale and the sign of a NaN.
std::string text(double number, int digits = 9) {
  if (std::isnan(number)) return "nan";
  std::ostringstream stream;
  stream.imbue(std::locale::classic());
  stream.precision(digits);
  stream << number;
  return stream.str();
}

}  // namespace

void check_command(const double* speeds, std::size_t count, std::size_t width, double fastest) {
  if (count != width) {
    throw InputError("the command has " + std::to_string(count) + " rotor speeds. Give " +
                     std::to_string(width) + ".");
  }
  const auto refuse = [](std::size_t i, const std::string& why) {
    throw InputError("the command for rotor " + std::to_string(i + 1) + " is " + why +
                     ". Give a speed in rad/s.");
  };
  for (std::size_t i = 0; i < count; ++i) {
    if (!std::isfinite(speeds[i])) refuse(i, "not a finite number");
    if (std::abs(speeds[i]) > fastest) {
      refuse(i, "beyond " + text(fastest, 6) +
                    " rad/s, the limit at which a flight counts as diverged");
    }
  }
}

Commands::Commands(Table table, std::size_t width) : table_(std::move(table)) {
  if (table_.rows() == 0 || table_.cols() != static_cast<Eigen::Index>(width) + 1) {
    throw InputError("commands: the table has " + std::to_string(table_.rows()) + " rows and " +
                     std::to_string(table_.cols()) + " columns. Write rows of time and " +
                     std::to_string(width) + " rotor speeds.");
  }
  if (const auto found = fault(table_)) {
    throw InputError("commands: row " + std::to_string(found->row) + ": " + found->what);
  }
}

std::optional<Commands::Fault> Commands::fault(const Table& table) {
  if (table.rows() > 0 && table.cols() == 0) return Fault{0, "there is no time. Write t first."};
  for (Eigen::Index row = 0; row < table.rows(); ++row) {
    for (Eigen::Index column = 0; column < table.cols(); ++column) {
      if (std::isfinite(table(row, column))) continue;
      const std::string name = column ? "w" + std::to_string(column) : "t";
      return Fault{row, name + " is " + text(table(row, column)) + ". Write a finite number."};
    }
  }
  for (Eigen::Index row = 1; row < table.rows(); ++row) {
    if (table(row, 0) > table(row - 1, 0)) continue;
    return Fault{row, "t = " + text(table(row, 0)) + " is not later than " +
                          text(table(row - 1, 0)) + ". Sort the rows by time."};
  }
  return std::nullopt;
}

const double* Commands::at(double time) {
  while (next_ < table_.rows() && table_(next_, 0) <= time + 1e-9) ++next_;
  while (next_ > 0 && table_(next_ - 1, 0) > time + 1e-9) --next_;
  return next_ > 0 ? table_.row(next_ - 1).data() + 1 : nullptr;
}

}  // namespace quadcore
