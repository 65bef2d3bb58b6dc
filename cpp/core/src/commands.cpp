#include "quadcore/commands.hpp"

#include <string>

#include "quadcore/error.hpp"

namespace quadcore {

Commands::Commands(Table table, std::size_t width) : table_(std::move(table)) {
  if (table_.rows() == 0 || table_.cols() != static_cast<Eigen::Index>(width) + 1) {
    throw InputError("commands: a table of " + std::to_string(table_.rows()) + " rows and " +
                     std::to_string(table_.cols()) + " columns; write rows of time and " +
                     std::to_string(width) + " rotor speeds");
  }
  if (!table_.allFinite()) {
    throw InputError("commands: a value is not a finite number; write times in s, speeds in rad/s");
  }
  for (Eigen::Index i = 1; i < table_.rows(); ++i) {
    if (table_(i, 0) <= table_(i - 1, 0)) {
      throw InputError("commands: row " + std::to_string(i) +
                       " is not later than the row before; sort the rows by time");
    }
  }
}

const double* Commands::at(double time) {
  while (next_ < table_.rows() && table_(next_, 0) <= time + 1e-9) ++next_;
  while (next_ > 0 && table_(next_ - 1, 0) > time + 1e-9) --next_;
  return next_ > 0 ? table_.row(next_ - 1).data() + 1 : nullptr;
}

}  // namespace quadcore
