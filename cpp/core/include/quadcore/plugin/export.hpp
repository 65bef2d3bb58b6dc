#pragma once

/// \file
/// Symbol visibility: the shared library exports only the declarations in the namespaces of public
/// headers, and binaries that link the static library export nothing of it.

#ifdef QUADCORE_STATIC
#define QUADCORE_EXPORT
#else
/// Marks a namespace whose declarations the shared library exports.
#define QUADCORE_EXPORT __attribute__((visibility("default")))
#endif
