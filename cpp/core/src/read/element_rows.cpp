#include "element_rows.hpp"

#include <utility>

#include "quadcore/text.hpp"

namespace quadcore {

using Element = Xml::Element;

bool ElementRows::is_empty(const Element& e) const {
  if (!xml_.text(e).empty()) return false;
  skip(e, "empty <" + std::string(e.Name()) + ">");
  return true;
}

void ElementRows::skip(const Element& e, const std::string& what) const {
  xml_.ignored_elements().add_harmless(what, xml_.where(e));
}

void ElementRows::skip_here(const Element& e) const {
  skip(e, "<" + std::string(e.Name()) + "> in <" + e.Parent()->ToElement()->Name() + ">");
}

ElementRow ElementRows::number(std::string path, std::string unit, double& target,
                               const Range& range, std::string meaning) const {
  std::string fallback;
  append_shortest(target, fallback);
  TagSpec spec = TagSpec::number(std::move(path), std::move(unit), fallback, std::move(meaning));
  spec.min = range.min, spec.max = range.max, spec.exclusive_min = range.open;
  return {spec, [this, spec, &target](const Element& e) {
            if (is_empty(e)) return;
            target = xml_.number_in_text(e);
            const bool is_above = spec.exclusive_min ? target > spec.min : target >= spec.min;
            if (is_above && target <= spec.max) return;
            xml_.fail(e, "<" + std::string(e.Name()) + "> is out of range. Use a number " +
                             spec.interval() + ".");
          }};
}

ElementRow ElementRows::vector(std::string path, std::string unit, Vector3d& target,
                               std::string meaning) const {
  std::string fallback;
  for (int i = 0; i < 3; ++i) {
    append_shortest(target[i], fallback.empty() ? fallback : fallback += ' ');
  }
  return {TagSpec::numbers(std::move(path), std::move(unit), fallback, std::move(meaning)).of(3),
          [this, &target](const Element& e) {
            if (!is_empty(e)) target = xml_.vector_in_text(e);
          }};
}

ElementRow ElementRows::word(const TagSpec& spec) const {
  return {spec, [this, spec](const Element& e) {
            if (is_empty(e)) return;
            const std::string text = xml_.text(e);
            std::string alternatives;
            for (const std::string& choice : spec.choices) {
              if (text == choice) return;
              alternatives += (alternatives.empty() ? "" : " or ") + choice;
            }
            xml_.fail(
                e, "<" + std::string(e.Name()) + "> is '" + text + "'. Use " + alternatives + ".");
          }};
}

ElementRow ElementRows::other(std::string path, std::string meaning,
                              std::function<void(const Element&)> read) {
  TagSpec spec = TagSpec::text(std::move(path), "", std::move(meaning));
  spec.kind = TagKind::choice;
  return {spec, std::move(read)};
}

}  // namespace quadcore
