#pragma once

#include "quadcore/plugin/document.hpp"

namespace quadcore {

/// Reject a document that would block the parser, overflow its stack or end it early: one that is
/// too large, not UTF-8, nested too deeply, or has too many attributes on one element. The limits
/// are far beyond any model or world. Throws InputError with FILE:LINE.
/// \param largest  maximum size in bytes
void check_xml_limits(const Document& document, std::size_t largest);

}  // namespace quadcore
