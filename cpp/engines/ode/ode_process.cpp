#include "ode_process.hpp"

#include <ode/ode.h>

#include <cstdarg>
#include <cstdio>
#include <mutex>
#include <string>

#include "quadcore/plugin/error.hpp"

namespace quadcore {
namespace {

/// ODE's functions are C++ and unwind; its bodies are left in the middle of a step.
void throw_error(int, const char* format, std::va_list values) {
  char what[256];
  std::vsnprintf(what, sizeof what, format, values);
  throw Error("ODE gave up on the motion (" + std::string(what) +
              "); try a smaller step or weaker commands");
}

/// What ODE notes on standard error before it gives up; the Error says it.
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
  if (!allocated) throw Error("ODE could not be initialised in this thread");
}

}  // namespace quadcore
