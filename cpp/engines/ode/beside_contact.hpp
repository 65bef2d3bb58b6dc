#pragma once

namespace quadcore {

/// So many steps beside a contact the sweeps have not converged: they start from multipliers that
/// an impact has made large.
constexpr int steps_beside_contact = 50;

}  // namespace quadcore
