#include "quadcore/control/rows_file.hpp"

#include <algorithm>
#include <optional>
#include <sstream>

#include "files/yaml_file.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/plugin/spatial.hpp"
#include "quadcore/text.hpp"
#include "quadcore/text_file.hpp"

namespace quadcore::control {
namespace {

const std::vector<std::string> columns = {"t", "x", "y", "z"};
const std::vector<std::string> of_orientation = {"qx", "qy", "qz", "qw"};
constexpr const char* yaw_column = "yaw";

/// Indices of the columns to read: time and position, and optionally yaw or an orientation.
struct Header {
  std::vector<std::size_t> places, yaw;

  std::size_t width() const { return places.size() + (yaw.empty() ? 0 : 1); }
};

/// Return the header for the columns t, x, y, z and optionally yaw in any order, or for a log,
/// which has an orientation and other columns; nullopt for other names.
std::optional<Header> header_of(const std::vector<std::string>& names) {
  const auto places = [&](const std::vector<std::string>& wanted) {
    std::vector<std::size_t> found;
    for (const std::string& name : wanted) {
      if (std::count(names.begin(), names.end(), name) != 1) continue;
      const auto at = std::find(names.begin(), names.end(), name) - names.begin();
      found.push_back(static_cast<std::size_t>(at));
    }
    return found;
  };
  const Header of_log{places(columns), places(of_orientation)},
      of_rows{of_log.places, places({yaw_column})};
  if (of_log.places.size() != columns.size()) return {};
  if (of_log.yaw.size() == of_orientation.size()) return of_log;
  if (names.size() == of_rows.width()) return of_rows;
  return {};
}

/// Collects rows and rejects those that form no path.
class RowCollector {
 public:
  explicit RowCollector(const Header& header) : header_(header) {}

  /// \param number   returns the value of a column of the file
  /// \param refuse   throws an error with the location of the row
  template <class Number, class Refuse>
  void add(const Number& number, const Refuse& refuse) {
    const double t = number(header_.places.front());
    if (rows_ > 0 && !(t > last_)) {
      refuse("is not later than the row before. Sort the rows by time.");
    }
    last_ = t;
    rows_ += 1;
    for (const std::size_t place : header_.places) values_.push_back(number(place));
    const std::vector<std::size_t>& of_yaw = header_.yaw;
    if (of_yaw.size() == 1) values_.push_back(number(of_yaw.front()));
    if (of_yaw.size() == of_orientation.size()) {
      const Quaterniond q(number(of_yaw[3]), number(of_yaw[0]), number(of_yaw[1]),
                          number(of_yaw[2]));
      values_.push_back(rpy_from_quaternion(q.normalized()).z());
    }
  }

  Rows rows(const std::string& path) const {
    if (rows_ < 2) {
      throw InputError(path + ": the file has fewer than two rows. Give at least two.");
    }
    const auto width = static_cast<Eigen::Index>(header_.width());
    return Eigen::Map<const Rows>(values_.data(), rows_, width);
  }

 private:
  Header header_;
  std::vector<double> values_;
  Eigen::Index rows_ = 0;
  double last_ = 0;
};

Rows read_yaml_rows(const std::string& path) {
  const YamlFile file(path);
  YAML::Node named, rows;
  for (const auto& [key, node] : file.mapping(file.root(), "the file")) {
    if (key != "columns" && key != "rows") {
      file.refuse(node, "unknown key '" + key + "'. Use only columns and rows.");
    }
    (key == "rows" ? rows : named).reset(node);
  }
  std::vector<std::string> names;
  if (named.IsSequence()) {
    for (const YAML::Node& name : named) names.push_back(file.text(name, "the column"));
  }
  const std::optional<Header> header = header_of(names);
  if (!header) {
    file.refuse(named.IsNull() ? file.root() : named,
                "'columns' is invalid. Write `columns: [t, x, y, z]` or `columns: [t, x, y, z, "
                "yaw]`, and `rows`.");
  }
  if (!rows.IsSequence())
    file.refuse(file.root(), "'rows' is not a list. Write a list of rows of numbers.");
  RowCollector collector(*header);
  for (const YAML::Node& row : rows) {
    if (!row.IsSequence() || row.size() != names.size()) {
      file.refuse(row, "the row does not have " + std::to_string(names.size()) +
                           " numbers. Write one number for each column.");
    }
    collector.add([&](std::size_t i) { return file.number(row[i], names[i]); },
                  [&](const char* what) { file.refuse(row, std::string("the row ") + what); });
  }
  return collector.rows(path);
}

std::vector<std::string> split_cells(const std::string& line) {
  std::vector<std::string> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    cells.push_back(trimmed(line.substr(begin, end - begin)));
    begin = end + 1;
  }
  return cells;
}

Rows read_csv_rows(const std::string& path) {
  std::istringstream text(read_text_file(path));
  std::string line;
  std::getline(text, line);
  const std::vector<std::string> names = split_cells(line);
  const std::optional<Header> header = header_of(names);
  if (!header) {
    throw InputError(path + ":1: the header is '" + trimmed(line) +
                     "'. Use t,x,y,z or t,x,y,z,yaw, or give a log.");
  }
  RowCollector collector(*header);
  for (int number = 2; std::getline(text, line); ++number) {
    if (trimmed(line).empty()) continue;
    const std::string where = path + ":" + std::to_string(number) + ": ";
    const std::vector<std::string> row = split_cells(line);
    if (row.size() != names.size()) {
      throw InputError(where + std::to_string(row.size()) + " columns instead of " +
                       std::to_string(names.size()) + ". Write one number for each column.");
    }
    const auto value = [&](std::size_t i) {
      const auto parsed = parse_number(row[i]);
      if (!parsed)
        throw InputError(where + "'" + row[i] + "' is not a finite number. Write a finite number.");
      return *parsed;
    };
    collector.add(value, [&](const char* what) { throw InputError(where + "the row " + what); });
  }
  return collector.rows(path);
}

}  // namespace

Rows read_rows(const std::string& path) {
  const auto ends_with = [&](const std::string& end) {
    return path.size() > end.size() && path.compare(path.size() - end.size(), end.size(), end) == 0;
  };
  if (ends_with(".csv")) return read_csv_rows(path);
  if (ends_with(".yaml") || ends_with(".yml")) return read_yaml_rows(path);
  throw InputError(path + ": rows can be read only from .csv and .yaml files. Give one of these.");
}

}  // namespace quadcore::control
