// The versions of Mesa and of LLVM, which compiles its shaders.
#pragma once

#include "core/library_versions.h"

namespace understudy::renderer {

/// As a context tells them, which is made once in a process. Empty where OSMesa cannot make one.
LibraryVersions library_versions();

}  // namespace understudy::renderer
