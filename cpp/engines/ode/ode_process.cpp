#include "ode_process.hpp"

#include <ode/ode.h>

#include <cstdarg>
#include <cstdio>
#include <mutex>
#include <string>

#include "quadcore/plugin/error.hpp"

namespace quadcore {
namespace {

/// Throw through ODE's functions, which are C++; the bodies remain in the middle of a step.
void throw_error(int, const char* format, std::va_list values) {
  char what[256];
  std::vsnprintf(what, sizeof what, format, values);
  throw Error("ODE failed (" + std::string(what) + "). Try a smaller step or weaker commands.");
}

/// Suppress ODE's output on standard error before a failure; the Error contains it.
void say_nothing(int, const char*, std::va_list) {}

}  // namespace

void start_ode() {
  static std::once_flag once;
  std::call_once(once, [] {
    dInitODE2(0);
    dSetErrorHandler(&throw_error);
    dSetDebugHandler(&throw_error);
    dSetMessageHandler(&say_nothing);
  });
  thread_local const int allocated = dAllocateODEDataForThread(dAllocateMaskAll);
  if (!allocated) throw Error("ODE could not be initialised in this thread.");
}

}  // namespace quadcore
