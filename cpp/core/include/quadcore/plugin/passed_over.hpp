#pragma once

#include <set>
#include <string>
#include <vector>

#include "quadcore/plugin/export.hpp"

namespace quadcore QUADCORE_EXPORT {

/// What the reader of a model or a world met and did not take in.
class PassedOver {
 public:
  PassedOver() = default;
  /// \param ignore  names of foreign things that the user wants left out: an element's name, the
  ///                name or the file name of a plugin, the uri or the name of a world's model.
  explicit PassedOver(std::vector<std::string> ignore);

  /// Whether the user wants something that goes by any of these names left out.
  bool ignores(const std::vector<std::string>& names);
  /// Notes something that no vehicle feels, and its FILE:LINE.
  void add_unfelt(const std::string& what, const std::string& where);

  /// Those of the names to ignore that were met, in the user's order.
  std::vector<std::string> ignored() const;
  /// Every name that could have been ignored.
  const std::set<std::string>& known() const { return known_; }
  /// One line that names all that is unfelt, each with its places; "" if there is nothing.
  std::string warning() const;

 private:
  struct Unfelt {
    std::string what;
    std::vector<std::string> places;
  };
  std::vector<std::string> ignore_;
  std::vector<bool> met_;  ///< by name to ignore
  std::set<std::string> known_;
  std::vector<Unfelt> unfelt_;
};

/// How to leave something out, as the end of an error: "; to fly without it: --ignore NAME".
std::string ignoring(const std::string& name);

/// Those of the names to ignore that were met in any of what was read, each once.
std::vector<std::string> ignored_in(const std::vector<const PassedOver*>& readings);
/// Throws InputError if a name to ignore was met in none of what was read, naming what is there.
void check_ignored(const std::vector<std::string>& ignore,
                   const std::vector<const PassedOver*>& readings);

}  // namespace quadcore
