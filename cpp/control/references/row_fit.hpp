#pragma once

#include <vector>

#include "references/septic_path.hpp"

namespace quadcore::control {

/// Return the unit of the last digit of each column except the first: at least 1e-10, at most 1e-3.
VectorXd last_digits(const Rows& rows);

/// Fit a spline of degree seven, with six continuous derivatives, to the rows of a motion and
/// return its knots. It uses the smallest number of 1, 2, 4, ... equal pieces that is within the
/// tolerances of all rows. Returns nothing if this takes more pieces than a quarter of the rows, or
/// for fewer than 16 rows. A path through each row would follow the rounding errors: 1e-6 m at 100
/// Hz is a snap of about 1e4 m/s^4.
/// \param tolerances  tolerance of each column except the first
std::vector<SepticPath::Point> fitted(const Rows& rows, const VectorXd& tolerances);

}  // namespace quadcore::control
