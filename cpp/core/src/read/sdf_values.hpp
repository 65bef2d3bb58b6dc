#pragma once

#include <initializer_list>

#include "xml.hpp"

namespace quadcore {

/// Return the first element at a path below another, or null; null has no children.
const Xml::Element* descend(const Xml::Element* e, std::initializer_list<const char*> names);

/// Return the number in a child, or a fallback if there is none or it is empty.
double number_or(const Xml& xml, const Xml::Element* parent, const char* name, double fallback);

/// Return whether an element contains `true` or `1`.
bool is_true(const Xml& xml, const Xml::Element* e);

}  // namespace quadcore
