/// \file
/// The functions of FMI 2.0 for co-simulation. Each catches exceptions, reports them through the
/// importer's logger and returns the status.

#include "fmi2.hpp"

#include <exception>
#include <memory>
#include <string>

#include "instance.hpp"
#include "quadcore/plugin/error.hpp"

namespace {

using quadcore::fmu::Instance;
using quadcore::fmu::SavedState;
using quadcore::fmu::Variable;

/// The component of an importer.
struct Component {
  std::string name;
  fmi2CallbackFunctions callbacks = {};
  std::unique_ptr<Instance> instance;
};

void say(const std::string& name, const fmi2CallbackFunctions& callbacks, fmi2Status status,
         const std::string& what) {
  if (!callbacks.logger) return;
  std::string escaped;  // the logger treats the text as a format
  for (const char c : what) escaped.append(c == '%' ? 2 : 1, c);
  callbacks.logger(callbacks.environment, name.c_str(), status,
                   status == fmi2Warning ? "logStatusWarning" : "logStatusError", escaped.c_str());
}

/// Call f(instance) and log its exception or the flight's warnings.
template <class Function>
fmi2Status guarded(fmi2Component c, const Function& f) {
  if (!c) return fmi2Error;
  auto& component = *static_cast<Component*>(c);
  try {
    f(*component.instance);
  } catch (...) {
    say(component.name, component.callbacks, fmi2Error, quadcore::what_was_thrown());
    return fmi2Error;
  }
  for (const std::string& warning : component.instance->take_warnings()) {
    say(component.name, component.callbacks, fmi2Warning, warning);
  }
  return fmi2OK;
}

/// Call f(instance, i) for each of n values.
template <class Function>
fmi2Status for_each(fmi2Component c, std::size_t n, const Function& f) {
  return guarded(c, [&](Instance& instance) {
    for (std::size_t i = 0; i < n; ++i) f(instance, i);
  });
}

int hex(char c) {
  return c >= '0' && c <= '9'                     ? c - '0'
         : (c | 0x20) >= 'a' && (c | 0x20) <= 'f' ? (c | 0x20) - 'a' + 10
                                                  : -1;
}

/// Return the folder of a file URI.
std::string path_of(const std::string& uri) {
  std::string path = uri;
  if (path.rfind("file:", 0) == 0) path.erase(0, 5);
  if (path.rfind("//", 0) == 0) path.erase(0, path.find('/', 2));  // host
  std::string decoded;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const bool is_code =
        path[i] == '%' && i + 2 < path.size() && hex(path[i + 1]) >= 0 && hex(path[i + 2]) >= 0;
    decoded += is_code ? static_cast<char>(16 * hex(path[i + 1]) + hex(path[i + 2])) : path[i];
    if (is_code) i += 2;
  }
  return decoded;
}

fmi2Status unsupported(fmi2Component c, const char* what) {
  return guarded(c, [what](Instance&) {
    throw quadcore::InputError(std::string(what) +
                               " is not supported. See the capabilities in modelDescription.xml.");
  });
}

SavedState& state_of(fmi2FMUstate state) {
  if (!state)
    throw quadcore::InputError("the given FMU state does not exist. Call fmi2GetFMUstate first.");
  return *static_cast<SavedState*>(state);
}

}  // namespace

#pragma GCC visibility push(default)
extern "C" {

const char* fmi2GetTypesPlatform() { return "default"; }
const char* fmi2GetVersion() { return "2.0"; }

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions* given, fmi2Boolean, fmi2Boolean) {
  if (!name) name = "";
  const fmi2CallbackFunctions callbacks = given ? *given : fmi2CallbackFunctions();
  try {
    if (type != fmi2CoSimulation)
      throw quadcore::InputError(
          "this FMU supports only co-simulation. Instantiate it with fmi2CoSimulation.");
    if (!resources)
      throw quadcore::InputError(
          "the resource location is missing. Pass the URI of the FMU's resources folder.");
    if (!guid)
      throw quadcore::InputError("the GUID is missing. Pass the GUID of modelDescription.xml.");
    auto component = std::make_unique<Component>();
    component->name = name;
    component->callbacks = callbacks;
    component->instance = std::make_unique<Instance>(path_of(resources), guid);
    return component.release();
  } catch (...) {
    say(name, callbacks, fmi2Error, quadcore::what_was_thrown());
    return nullptr;
  }
}

void fmi2FreeInstance(fmi2Component c) { delete static_cast<Component*>(c); }

/// Errors and warnings are always logged.
fmi2Status fmi2SetDebugLogging(fmi2Component, fmi2Boolean, std::size_t, const fmi2String*) {
  return fmi2OK;
}

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean, fmi2Real, fmi2Real start, fmi2Boolean,
                               fmi2Real) {
  return guarded(c, [start](Instance& instance) { instance.start_at(start); });
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c) {
  return guarded(c, [](Instance& instance) { instance.initialise(); });
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c) {
  return guarded(c, [](Instance& instance) { instance.begin(); });
}

fmi2Status fmi2Terminate(fmi2Component) { return fmi2OK; }

fmi2Status fmi2Reset(fmi2Component c) {
  return guarded(c, [](Instance& instance) { instance.reset(); });
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real step, fmi2Boolean) {
  return guarded(c, [time, step](Instance& instance) { instance.step(time, step); });
}

fmi2Status fmi2CancelStep(fmi2Component c) { return unsupported(c, "an asynchronous step"); }

// Values

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference* v, std::size_t n, fmi2Real* to) {
  return for_each(c, n,
                  [=](Instance& i, std::size_t k) { to[k] = i.number(v[k], Variable::real); });
}
fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference* v, std::size_t n,
                          fmi2Integer* to) {
  return for_each(c, n, [=](Instance& i, std::size_t k) {
    to[k] = static_cast<fmi2Integer>(i.number(v[k], Variable::integer));
  });
}
fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference* v, std::size_t n,
                          fmi2Boolean* to) {
  return for_each(
      c, n, [=](Instance& i, std::size_t k) { to[k] = i.number(v[k], Variable::boolean) != 0; });
}
fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference* v, std::size_t n,
                         fmi2String* to) {
  return for_each(c, n, [=](Instance& i, std::size_t k) { to[k] = i.text(v[k]).c_str(); });
}
fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference* v, std::size_t n,
                       const fmi2Real* values) {
  return for_each(
      c, n, [=](Instance& i, std::size_t k) { i.set_number(v[k], Variable::real, values[k]); });
}
fmi2Status fmi2SetInteger(fmi2Component c, const fmi2ValueReference* v, std::size_t n,
                          const fmi2Integer* values) {
  return for_each(
      c, n, [=](Instance& i, std::size_t k) { i.set_number(v[k], Variable::integer, values[k]); });
}
fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference* v, std::size_t n,
                          const fmi2Boolean* values) {
  return for_each(
      c, n, [=](Instance& i, std::size_t k) { i.set_number(v[k], Variable::boolean, values[k]); });
}
fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference* v, std::size_t n,
                         const fmi2String* values) {
  return for_each(c, n, [=](Instance& i, std::size_t k) { i.set_text(v[k], values[k]); });
}

// State

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate* state) {
  return guarded(c, [state](Instance& instance) {
    SavedState saved = instance.save();
    if (*state) {
      state_of(*state) = std::move(saved);
    } else {
      *state = new SavedState(std::move(saved));
    }
  });
}
fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state) {
  return guarded(c, [state](Instance& instance) { instance.restore(state_of(state)); });
}
fmi2Status fmi2FreeFMUstate(fmi2Component, fmi2FMUstate* state) {
  delete static_cast<SavedState*>(*state);
  *state = nullptr;
  return fmi2OK;
}
fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, std::size_t* size) {
  return guarded(c, [=](Instance&) { *size = serialised(state_of(state)).size(); });
}
fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte* to,
                                 std::size_t size) {
  return guarded(c, [=](Instance&) {
    const std::string bytes = serialised(state_of(state));
    if (bytes.size() > size)
      throw quadcore::InputError(
          "the buffer is too small for the state. Use the size from fmi2SerializedFMUstateSize.");
    bytes.copy(to, bytes.size());
  });
}
fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte* bytes, std::size_t size,
                                   fmi2FMUstate* state) {
  return guarded(c, [=](Instance& instance) {
    *state = new SavedState(quadcore::fmu::deserialised(instance.file(), std::string(bytes, size)));
  });
}

// Unsupported functions

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference*, std::size_t,
                                        const fmi2ValueReference*, std::size_t, const fmi2Real*,
                                        fmi2Real*) {
  return unsupported(c, "a directional derivative");
}
fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference*, std::size_t,
                                       const fmi2Integer*, const fmi2Real*) {
  return unsupported(c, "the derivative of an input");
}
fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference*, std::size_t,
                                        const fmi2Integer*, fmi2Real*) {
  return unsupported(c, "the derivative of an output");
}
fmi2Status fmi2GetStatus(fmi2Component c, fmi2StatusKind, fmi2Status*) {
  return unsupported(c, "a status");
}
fmi2Status fmi2GetRealStatus(fmi2Component c, fmi2StatusKind kind, fmi2Real* value) {
  if (kind != fmi2LastSuccessfulTime) return unsupported(c, "this status");
  return guarded(c, [value](Instance& instance) { *value = instance.time(); });
}
fmi2Status fmi2GetIntegerStatus(fmi2Component c, fmi2StatusKind, fmi2Integer*) {
  return unsupported(c, "a status");
}
fmi2Status fmi2GetBooleanStatus(fmi2Component c, fmi2StatusKind, fmi2Boolean*) {
  return unsupported(c, "a status");
}
fmi2Status fmi2GetStringStatus(fmi2Component c, fmi2StatusKind, fmi2String*) {
  return unsupported(c, "a status");
}

}  // extern "C"
#pragma GCC visibility pop
