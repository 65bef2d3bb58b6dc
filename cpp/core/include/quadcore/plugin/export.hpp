#pragma once

/// \file
/// What the namespace in a public header declares is exported from the shared library; everything
/// else stays inside, and a static library exports nothing from what it is linked into.

#ifdef QUADCORE_STATIC
#define QUADCORE_EXPORT
#else
/// Marks a namespace whose declarations the shared library exports.
#define QUADCORE_EXPORT __attribute__((visibility("default")))
#endif
