#include "quadcore/control/rows_file.hpp"

#include <sstream>

#include "control/files/text_file.hpp"
#include "control/files/yaml_file.hpp"
#include "quadcore/error.hpp"
#include "quadcore/text.hpp"

namespace quadcore::control {
namespace {

const std::vector<std::string> columns = {"t", "x", "y", "z", "yaw"};

/// Whether the names are columns, yaw being the one that may lack.
bool are_columns(const std::vector<std::string>& names) {
  return names == columns || names == std::vector<std::string>(columns.begin(), columns.end() - 1);
}

Rows stacked(const std::vector<double>& values, std::size_t width) {
  return Eigen::Map<const Rows>(values.data(), static_cast<Eigen::Index>(values.size() / width),
                                static_cast<Eigen::Index>(width));
}

Rows read_yaml_rows(const std::string& path) {
  const YamlFile file(path);
  YAML::Node named, rows;
  for (const auto& [key, node] : file.mapping(file.root(), "a file of rows")) {
    if (key != "columns" && key != "rows") {
      file.refuse(node, "a file of rows has no '" + key + "'; it knows columns, rows");
    }
    (key == "rows" ? rows : named).reset(node);
  }
  std::vector<std::string> names;
  for (const YAML::Node& name : named) names.push_back(file.text(name, "a column"));
  if (!are_columns(names)) {
    file.refuse(named.IsNull() ? file.root() : named,
                "write `columns: [t, x, y, z]`, or yaw besides, and `rows`");
  }
  if (!rows.IsSequence()) file.refuse(file.root(), "'rows' is no list; write rows of numbers");
  std::vector<double> values;
  for (const YAML::Node& row : rows) {
    if (!row.IsSequence() || row.size() != names.size()) {
      file.refuse(row, "is no row of " + std::to_string(names.size()) + " numbers");
    }
    for (std::size_t i = 0; i < names.size(); ++i) values.push_back(file.number(row[i], names[i]));
  }
  return stacked(values, names.size());
}

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(trimmed(cell));
  return cells;
}

Rows read_csv_rows(const std::string& path) {
  std::istringstream text(read_text_file(path));
  std::string line;
  std::getline(text, line);
  const std::vector<std::string> names = cells(line);
  if (!are_columns(names)) {
    throw InputError(path + ":1: the header is '" + trimmed(line) +
                     "'; write t,x,y,z or t,x,y,z,yaw");
  }
  std::vector<double> values;
  for (int number = 2; std::getline(text, line); ++number) {
    if (trimmed(line).empty()) continue;
    const std::string where = path + ":" + std::to_string(number) + ": ";
    const std::vector<std::string> row = cells(line);
    if (row.size() != names.size()) {
      throw InputError(where + std::to_string(row.size()) + " columns instead of " +
                       std::to_string(names.size()));
    }
    for (const std::string& cell : row) {
      const auto value = parse_number(cell);
      if (!value) throw InputError(where + "'" + cell + "' is no finite number; write one");
      values.push_back(*value);
    }
  }
  return stacked(values, names.size());
}

}  // namespace

Rows read_rows(const std::string& path) {
  const auto ends_with = [&](const std::string& end) {
    return path.size() > end.size() && path.compare(path.size() - end.size(), end.size(), end) == 0;
  };
  if (ends_with(".csv")) return read_csv_rows(path);
  if (ends_with(".yaml") || ends_with(".yml")) return read_yaml_rows(path);
  throw InputError(path + ": rows are read from .csv and .yaml files; give one of these");
}

}  // namespace quadcore::control
