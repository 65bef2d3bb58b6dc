#pragma once

#include <vector>

#include "references/septic_path.hpp"

namespace quadcore::control {

/// A unit of the last digit in which each column but the first is told, as its numbers show it: at
/// least 1e-10, at most 1e-3.
VectorXd last_digits(const Rows& rows);

/// Knots of a spline of the seventh order, its first six derivatives continuous, near rows of a
/// motion: of 1, 2, 4, ... equal pieces the first that is within the tolerances of all rows. Where
/// that takes more than a quarter of the rows, or with fewer than 16 rows, there is none.
///
/// Through each row itself a path would be that of the digits: a rounding of 1e-6 m at 100 Hz is a
/// snap of some 1e4 m/s^4.
/// \param tolerances  of each column but the first
std::vector<SepticPath::Point> fitted(const Rows& rows, const VectorXd& tolerances);

}  // namespace quadcore::control
