#pragma once

namespace quadcore {

/// Initialise ODE once per process and once per thread. Call it before any use of ODE in a thread.
/// Fatal errors of ODE, which would end the process, are then thrown as Error.
void start_ode();

}  // namespace quadcore
