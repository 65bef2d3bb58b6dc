#pragma once

namespace quadcore {

/// Initialises ODE, once per process and once per thread; call it before any use of ODE in a
/// thread. From then on whatever ODE takes for fatal, and would end the process for, is thrown as
/// an Error.
void start_ode();

}  // namespace quadcore
