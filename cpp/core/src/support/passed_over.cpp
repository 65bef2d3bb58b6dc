#include "quadcore/plugin/passed_over.hpp"

#include <algorithm>

#include "quadcore/plugin/error.hpp"
#include "quadcore/text.hpp"

namespace quadcore {
namespace {

bool holds(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

PassedOver::PassedOver(std::vector<std::string> ignore)
    : ignore_(std::move(ignore)), met_(ignore_.size(), false) {}

bool PassedOver::ignores(const std::vector<std::string>& names) {
  bool ignored = false;
  for (std::size_t i = 0; i < ignore_.size(); ++i) {
    if (!holds(names, ignore_[i])) continue;
    met_[i] = ignored = true;
  }
  known_.insert(names.begin(), names.end());
  return ignored;
}

void PassedOver::add_unfelt(const std::string& what, const std::string& where) {
  const auto same = std::find_if(unfelt_.begin(), unfelt_.end(),
                                 [&](const Unfelt& unfelt) { return unfelt.what == what; });
  if (same == unfelt_.end()) {
    unfelt_.push_back({what, {where}});
  } else if (same->places.back() != where) {  // a macro's line once
    same->places.push_back(where);
  }
}

std::vector<std::string> PassedOver::ignored() const {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < ignore_.size(); ++i) {
    if (met_[i] && !holds(names, ignore_[i])) names.push_back(ignore_[i]);
  }
  return names;
}

std::string PassedOver::warning() const {
  std::vector<std::string> list;
  for (const Unfelt& unfelt : unfelt_) {
    list.push_back(unfelt.what + " (" + joined(unfelt.places) + ")");
  }
  return list.empty() ? "" : "passed over, since nothing that flies feels it: " + joined(list);
}

std::string ignoring(const std::string& name) { return "; to fly without it: --ignore " + name; }

std::vector<std::string> ignored_in(const std::vector<const PassedOver*>& readings) {
  std::vector<std::string> names;
  for (const PassedOver* reading : readings) {
    for (const std::string& name : reading->ignored()) {
      if (!holds(names, name)) names.push_back(name);
    }
  }
  return names;
}

void check_ignored(const std::vector<std::string>& ignore,
                   const std::vector<const PassedOver*>& readings) {
  const std::vector<std::string> ignored = ignored_in(readings);
  std::set<std::string> all;
  for (const PassedOver* reading : readings) {
    all.insert(reading->known().begin(), reading->known().end());
  }
  const std::vector<std::string> known(all.begin(), all.end());
  for (const std::string& name : ignore) {
    if (holds(ignored, name)) continue;
    throw InputError("ignore " + name + ": nothing goes by that name" + did_you_mean(name, known) +
                     "; what can be left out: " + joined(known));
  }
}

}  // namespace quadcore
