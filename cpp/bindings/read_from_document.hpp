#pragma once

#include <pybind11/stl.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "built.hpp"
#include "quadcore/plugin/document.hpp"
#include "quadcore/plugin/error.hpp"
#include "unpickled.hpp"

/// \file
/// Common parts of the classes of models and worlds, which are read from documents.

namespace quadcore::bindings {

/// Version of the pickle format of models and worlds.
constexpr int pickle_version = 1;

inline const Source& source_of(const std::shared_ptr<const Source>& source) {
  if (!source) {
    throw InputError("this model was rounded by its engine. Pickle the model that was read.");
  }
  return *source;
}

/// Pickle the document and read it again, so that the pickle contains neither paths nor
/// inconsistent data.
template <class Read>
auto by_document(Read (*read)(const Document&, const std::vector<std::string>&)) {
  return py::pickle(
      [](const Built<Read>& held) -> py::object {
        const auto& [document, ignore] = source_of(held->source);
        return py::make_tuple(pickle_version, document.name, document.text, document.lines, ignore);
      },
      [read](const py::object& state) {
        return unpickled("the model or world", "Read", [&] {
          if (py::cast<int>(state[py::int_(0)]) != pickle_version) throw OtherVersion();
          return std::make_shared<Read>(read(
              {py::cast<std::string>(state[py::int_(1)]), py::cast<std::string>(state[py::int_(2)]),
               py::cast<std::vector<std::pair<std::string, int>>>(state[py::int_(3)])},
              py::cast<std::vector<std::string>>(state[py::int_(4)])));
        });
      });
}

/// Return a getter of a member of a model or world.
template <class T, class Member>
auto get(Member T::* member) {
  return [member](const Built<T>& built) -> Member { return (*built).*member; };
}

/// Return the document from which a model or world was read.
template <class T>
Document get_document(const Built<T>& built) {
  return source_of(built->source).document;
}

}  // namespace quadcore::bindings
