#pragma once

#include "quadcore/plugin/document.hpp"

namespace quadcore {

/// Refuses what would keep a parser busy for minutes, overflow its stack or end it early: a
/// document that is too large, no UTF-8 text, nested too deeply, or has too many attributes on one
/// element. The limits lie far beyond any model or world. Throws InputError with FILE:LINE.
void check_xml_limits(const Document& document);

}  // namespace quadcore
