#pragma once

#include <string>

#include "older_pybind11.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore::bindings {

/// Thrown for a pickle of another version.
struct OtherVersion {};

/// Read a pickle, which may be damaged. Every problem becomes an InputError of one line.
/// \param what  the pickled object, for errors
/// \param redo  imperative that obtains the object again, such as "Read"
template <class Read>
auto unpickled(const std::string& what, const std::string& redo, const Read& read) {
  try {
    return read();
  } catch (const OtherVersion&) {
    throw InputError(what + " was pickled by another version of quadcore. " + redo + " it again.");
  } catch (const Error&) {
    throw;
  } catch (const std::exception&) {  // including Python's exceptions, which pybind11 passes on
    throw InputError(what + " has a damaged pickle. " + redo + " it again.");
  }
}

}  // namespace quadcore::bindings
