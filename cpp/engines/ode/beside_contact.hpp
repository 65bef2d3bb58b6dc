#pragma once

namespace quadcore {

/// Number of steps after a contact in which the sweeps have not converged, because they start from
/// large multipliers of the impact.
constexpr int steps_beside_contact = 50;

}  // namespace quadcore
