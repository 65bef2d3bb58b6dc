#pragma once

#include <vector>

#include "gyrostat.hpp"
#include "quadcore/plugin/model.hpp"

namespace quadcore {

/// Of the oscillations that springs under all touching points at once make of a gyrostat: the
/// square of frequency times step, and decay times step. The roots of z^2 + c z + k for all c and k
/// up to these lie in the half disc of radius 2, where the classical Runge-Kutta method does not
/// grow (its limits are 2.78 along the real axis, 2.83 along the imaginary one).
constexpr double largest_square_per_step = 0.25, largest_damping_per_step = 2;

/// The stiffest contact of a shape at a step of 1 s; it goes with one over the square of the step.
struct StableContact {
  double pressing = 0;  ///< of each point across the ground [kg]
  double rubbing = 0;   ///< of the shape along the ground [kg]
};

/// Whether a shape is one of revolution about the joint that carries its link.
bool revolves(const Model& model, std::size_t link, const Collision& shape);

/// For each shape, link by link, springs so stiff that even under all points at once, in any
/// attitude, they keep to largest_square_per_step.
std::vector<StableContact> stable_contacts(const Model& model, const Gyrostat& body);

}  // namespace quadcore
