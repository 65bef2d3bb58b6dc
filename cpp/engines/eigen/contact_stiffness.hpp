#pragma once

#include <vector>

#include "gyrostat.hpp"
#include "quadcore/plugin/model.hpp"

namespace quadcore {

/// Limits for oscillations of a gyrostat on springs under all contact points: the square of
/// frequency times step, and decay times step. For all c and k up to these limits, the roots of z^2
/// + c z + k lie in the half disc of radius 2. There the classical Runge-Kutta method is stable
/// (its limits are 2.78 along the real axis and 2.83 along the imaginary axis).
constexpr double largest_square_per_step = 0.25, largest_damping_per_step = 2;

/// Maximum contact stiffness of a shape for a step of 1 s; it is proportional to the inverse square
/// of the step.
struct StableContact {
  double pressing = 0;  ///< of each point along the normal [kg]
  double rubbing = 0;   ///< of the shape along the ground [kg]
};

/// Return whether a shape is a body of revolution about the joint of its link.
bool revolves(const Model& model, std::size_t link, const Collision& shape);

/// Return the contact points of a shape with a pose; see touching_points().
using PlacePoints = std::vector<Vector3d> (*)(const Collision& shape, const Vector3d& p,
                                              const Matrix3d& R);
/// Those on the ground.
std::vector<Vector3d> place_touching_points(const Collision& shape, const Vector3d& p,
                                            const Matrix3d& R);

/// Maximum force of a point at the start of a flight, in weights of the vehicle.
constexpr double largest_start_force = 10;

/// Return for each shape, link by link, the stiffest springs that comply with
/// largest_square_per_step even under all points at once in any attitude.
std::vector<StableContact> stable_contacts(const Model& model, const Gyrostat& body,
                                           PlacePoints place_points = place_touching_points);

}  // namespace quadcore
