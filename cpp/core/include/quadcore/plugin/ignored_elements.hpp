#pragma once

#include <set>
#include <string>
#include <vector>

#include "quadcore/plugin/export.hpp"

namespace quadcore QUADCORE_EXPORT {

/// Elements that the reader of a model or a world found but did not use.
class IgnoredElements {
 public:
  IgnoredElements() = default;
  /// \param ignore  names of unknown things that the user ignores: the name of an element, the name
  ///                or file name of a plugin, the uri or the name of a model in a world.
  explicit IgnoredElements(std::vector<std::string> ignore);

  /// Return whether the user ignores any of these names.
  bool ignores(const std::vector<std::string>& names);
  /// Record something without effect on the motion, with its FILE:LINE.
  void add_harmless(const std::string& what, const std::string& where);
  /// Record something that may affect the motion but is not simulated, with its FILE:LINE.
  void add_unsimulated(const std::string& what, const std::string& where);

  /// Return the names to ignore that were found, in the user's order.
  std::vector<std::string> ignored() const;
  /// Return every name that could have been ignored.
  const std::set<std::string>& known() const { return known_; }
  /// Return a warning that lists everything without effect, with its locations; "" for nothing.
  std::string warning() const;
  /// Return what may affect the motion but is not simulated, in the order of the file.
  std::vector<std::string> unsimulated() const;
  /// Return a warning that lists that, with its locations; "" for nothing.
  std::string unsimulated_warning() const;

 private:
  struct Entry {
    std::string what;
    std::vector<std::string> places;
  };
  using Entries = std::vector<Entry>;
  static void add(Entries& entries, const std::string& what, const std::string& where);
  static std::string list(const Entries& entries);

  std::vector<std::string> ignore_;
  std::vector<bool> met_;  ///< one for each name to ignore
  std::set<std::string> known_;
  Entries harmless_;
  Entries unsimulated_;
};

/// Return the end of an error message that suggests --ignore NAME.
std::string suggest_ignoring(const std::string& name);

/// Return the names to ignore that were found in any of the documents, each once.
std::vector<std::string> ignored_in(const std::vector<const IgnoredElements*>& readings);
/// Throw InputError if a name to ignore was found in none of the documents.
void check_ignored(const std::vector<std::string>& ignore,
                   const std::vector<const IgnoredElements*>& readings);

}  // namespace quadcore
