#include "quadcore/plugin/ignored_elements.hpp"

#include <algorithm>

#include "quadcore/plugin/error.hpp"
#include "quadcore/text.hpp"

namespace quadcore {
namespace {

bool holds(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

IgnoredElements::IgnoredElements(std::vector<std::string> ignore)
    : ignore_(std::move(ignore)), met_(ignore_.size(), false) {}

bool IgnoredElements::ignores(const std::vector<std::string>& names) {
  bool ignored = false;
  for (std::size_t i = 0; i < ignore_.size(); ++i) {
    if (!holds(names, ignore_[i])) continue;
    met_[i] = ignored = true;
  }
  known_.insert(names.begin(), names.end());
  return ignored;
}

void IgnoredElements::add_harmless(const std::string& what, const std::string& where) {
  add(harmless_, what, where);
}

void IgnoredElements::add_unsimulated(const std::string& what, const std::string& where) {
  add(unsimulated_, what, where);
}

void IgnoredElements::add(Entries& entries, const std::string& what, const std::string& where) {
  const auto same = std::find_if(entries.begin(), entries.end(),
                                 [&](const Entry& entry) { return entry.what == what; });
  if (same == entries.end()) {
    entries.push_back({what, {where}});
  } else if (same->places.back() != where) {  // list a macro's line once
    same->places.push_back(where);
  }
}

std::vector<std::string> IgnoredElements::ignored() const {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < ignore_.size(); ++i) {
    if (met_[i] && !holds(names, ignore_[i])) names.push_back(ignore_[i]);
  }
  return names;
}

std::string IgnoredElements::list(const Entries& entries) {
  std::vector<std::string> all;
  for (const Entry& entry : entries) all.push_back(entry.what + " (" + joined(entry.places) + ")");
  return joined(all);
}

std::string IgnoredElements::warning() const {
  if (harmless_.empty()) return "";
  return "ignored, because it does not affect the motion: " + list(harmless_) + ".";
}

std::vector<std::string> IgnoredElements::unsimulated() const {
  std::vector<std::string> all;
  for (const Entry& entry : unsimulated_) all.push_back(entry.what);
  return all;
}

std::string IgnoredElements::unsimulated_warning() const {
  if (unsimulated_.empty()) return "";
  return "not simulated, though it may affect the motion: " + list(unsimulated_) + ".";
}

std::string suggest_ignoring(const std::string& name) {
  return " To simulate without it, use --ignore " + name + ".";
}

std::vector<std::string> ignored_in(const std::vector<const IgnoredElements*>& readings) {
  std::vector<std::string> names;
  for (const IgnoredElements* reading : readings) {
    for (const std::string& name : reading->ignored()) {
      if (!holds(names, name)) names.push_back(name);
    }
  }
  return names;
}

void check_ignored(const std::vector<std::string>& ignore,
                   const std::vector<const IgnoredElements*>& readings) {
  const std::vector<std::string> ignored = ignored_in(readings);
  std::set<std::string> all;
  for (const IgnoredElements* reading : readings) {
    all.insert(reading->known().begin(), reading->known().end());
  }
  const std::vector<std::string> known(all.begin(), all.end());
  for (const std::string& name : ignore) {
    if (holds(ignored, name)) continue;
    throw InputError("ignore " + name +
                     ": neither the model nor the world has anything of that name to ignore." +
                     suggest(name, known) + " Choose from: " + joined(known) + ".");
  }
}

}  // namespace quadcore
