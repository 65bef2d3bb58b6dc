#pragma once

/// \file
/// What the namespace in a public header declares is exported from the shared library; everything
/// else stays inside.

#define QUADCORE_EXPORT __attribute__((visibility("default")))
