#pragma once

#include <string>

#include "older_pybind11.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore::bindings {

/// Thrown where what was pickled is of another version.
struct OtherVersion {};

/// Reads what was pickled of a thing, which somebody may have damaged: whatever is wrong with it is
/// an InputError of one line, with what to do to have it anew.
template <class Read>
auto unpickled(const std::string& what, const std::string& anew, const Read& read) {
  try {
    return read();
  } catch (const OtherVersion&) {
    throw InputError(what + " was pickled by another version of quadcore; " + anew + " it anew");
  } catch (const Error&) {
    throw;
  } catch (const std::exception&) {  // also Python's own, as pybind11 passes them on
    throw InputError(what + " that was pickled is damaged; " + anew + " it anew");
  }
}

}  // namespace quadcore::bindings
