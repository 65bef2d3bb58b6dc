#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "quadcore/plugin/error.hpp"
#include "quadcore/plugin/spatial.hpp"
#include "quadcore/text.hpp"
#include "quadcore/text_file.hpp"

namespace quadcore::rotors {

/// A static wind field on a grid that follows the terrain: columns at equal distances in x and y,
/// each with its own bottom and top, and points at the same fractions of that height (RotorS' wiki,
/// "Adding a custom wind field to your world"). In rows, x varies fastest, then y, then z.
class WindField {
 public:
  /// Throws InputError with FILE:LINE.
  explicit WindField(const std::string& path) {
    read(path);
    min_x_ = number("min_x");
    min_y_ = number("min_y");
    n_x_ = whole("n_x");
    n_y_ = whole("n_y");
    res_x_ = positive("res_x");
    res_y_ = positive("res_y");
    shares_ = row("vertical_spacing_factors").numbers;
    check_shares();
    const std::size_t columns = n_x_ * n_y_, points = columns * shares_.size();
    bottom_ = rows_of("bottom_z", columns);
    top_ = rows_of("top_z", columns);
    for (std::size_t i = 0; i < columns; ++i) {
      if (bottom_[i] < top_[i]) continue;
      fail(row("top_z"), "top_z of column " + std::to_string(i) +
                             ", counted from 0, is not above its bottom_z. Use a greater height.");
    }
    const std::array<const char*, 3> axes = {"u", "v", "w"};
    for (std::size_t axis = 0; axis < 3; ++axis) velocity_[axis] = rows_of(axes[axis], points);
    rows_.clear();
  }

  /// Return the wind at a position, or nothing outside the field. It is interpolated linearly along
  /// each column, with extrapolation beyond its ends, then between the four columns around. The
  /// field ends at the outer columns, above all four tops and below all four bottoms.
  bool at(const Vector3d& p_W, Vector3d& v_WA_W) const {
    const double x = (p_W.x() - min_x_) / res_x_, y = (p_W.y() - min_y_) / res_y_;
    const auto last_x = static_cast<double>(n_x_ - 1), last_y = static_cast<double>(n_y_ - 1);
    if (!(x >= 0 && x <= last_x && y >= 0 && y <= last_y)) return false;
    const double i = std::min(std::floor(x), last_x - 1), j = std::min(std::floor(y), last_y - 1);
    bool below_a_top = false, above_a_bottom = false;
    Vector3d sum = Vector3d::Zero();
    for (const int right : {0, 1}) {
      for (const int behind : {0, 1}) {
        const std::size_t column =
            static_cast<std::size_t>(i) + static_cast<std::size_t>(right) +
            (static_cast<std::size_t>(j) + static_cast<std::size_t>(behind)) * n_x_;
        const double share = (p_W.z() - bottom_[column]) / (top_[column] - bottom_[column]);
        below_a_top = below_a_top || share <= 1;
        above_a_bottom = above_a_bottom || share >= 0;
        const double weight = (right ? x - i : 1 - (x - i)) * (behind ? y - j : 1 - (y - j));
        sum += weight * along(column, share);
      }
    }
    if (!below_a_top || !above_a_bottom) return false;
    v_WA_W = sum;
    return true;
  }

 private:
  struct Row {
    std::string where;
    std::vector<double> numbers;
  };

  [[noreturn]] static void fail(const Row& row, const std::string& what) {
    throw InputError(row.where + ": " + what);
  }

  /// Read a name with a colon and the numbers up to the next name.
  void read(const std::string& path) {
    const std::vector<std::string> names = {
        "min_x",    "min_y", "n_x", "n_y", "res_x", "res_y", "vertical_spacing_factors",
        "bottom_z", "top_z", "u",   "v",   "w"};
    std::istringstream file(read_text_file(path));
    Row* row = nullptr;
    std::string text;
    for (int line = 1; std::getline(file, text); ++line) {
      const std::string where = path + ":" + std::to_string(line);
      for (const std::string& word : split(text)) {
        if (word.back() == ':') {
          const std::string name = word.substr(0, word.size() - 1);
          if (std::find(names.begin(), names.end(), name) == names.end()) {
            throw InputError(where + ": '" + name + "' is not a quantity of a wind field." +
                             suggest(name, names) + " Use one of " + joined(names) + ".");
          }
          const auto [added, first] = rows_.emplace(name, Row{where, {}});
          row = &added->second;
          if (first) continue;
          throw InputError(where + ": a second " + name + " (first at " + row->where +
                           "). Keep one of them.");
        }
        const auto value = parse_number(word);
        if (!value || !row) {
          throw InputError(where + ": '" + word + "' is not a finite number" +
                           (row ? "" : " of a quantity") +
                           ". Write NAME: followed by its numbers, separated by blanks.");
        }
        row->numbers.push_back(*value);
      }
    }
    for (const std::string& name : names) {
      if (rows_.count(name)) continue;
      throw InputError(path + ": " + name + " is missing. Write " + name +
                       ": followed by its numbers.");
    }
  }

  const Row& row(const std::string& name) const { return rows_.at(name); }
  std::vector<double> rows_of(const std::string& name, std::size_t count) const {
    const Row& found = row(name);
    if (found.numbers.size() == count) return found.numbers;
    fail(found, name + " has " + std::to_string(found.numbers.size()) +
                    " numbers, but the grid requires " + std::to_string(count) +
                    ". Write as many.");
  }
  double number(const std::string& name) const { return rows_of(name, 1).front(); }
  double positive(const std::string& name) const {
    const double value = number(name);
    if (!(value > 0)) fail(row(name), name + " is not positive. Use a positive distance in m.");
    return value;
  }
  std::size_t whole(const std::string& name) const {
    const double value = number(name);
    if (value != std::floor(value) || value < 2 || value > 1e4) {
      fail(row(name),
           name + " is not a valid number of points. Use a whole number from 2 to 10000.");
    }
    return static_cast<std::size_t>(value);
  }
  void check_shares() const {
    const bool grows =
        std::is_sorted(shares_.begin(), shares_.end(), [](double a, double b) { return a <= b; });
    if (shares_.size() >= 2 && grows && shares_.front() == 0 && shares_.back() == 1) return;
    fail(row("vertical_spacing_factors"),
         "vertical_spacing_factors do not rise from 0 to 1. Write fractions of a column's height, "
         "at least 0 1.");
  }

  /// Return the height at a fraction of a column.
  Vector3d along(std::size_t column, double share) const {
    const auto above = std::upper_bound(shares_.begin() + 1, shares_.end() - 1, share);
    const auto k = static_cast<std::size_t>(above - shares_.begin()) - 1;
    const double part = (share - shares_[k]) / (shares_[k + 1] - shares_[k]);
    const std::size_t low = column + k * n_x_ * n_y_, high = low + n_x_ * n_y_;
    Vector3d v;
    for (int axis = 0; axis < 3; ++axis) {
      const std::vector<double>& row = velocity_[static_cast<std::size_t>(axis)];
      v[axis] = (1 - part) * row[low] + part * row[high];
    }
    return v;
  }

  std::map<std::string, Row> rows_;  ///< rows during reading
  double min_x_ = 0, min_y_ = 0;     ///< m
  std::size_t n_x_ = 0, n_y_ = 0;
  double res_x_ = 0, res_y_ = 0;                 ///< m
  std::vector<double> shares_;                   ///< fractions of a column's height, from 0 to 1
  std::vector<double> bottom_, top_;             ///< bottom and top of each column [m]
  std::array<std::vector<double>, 3> velocity_;  ///< world axes [m/s]
};

}  // namespace quadcore::rotors
