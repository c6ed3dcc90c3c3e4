// The versions of all libraries that a rehearsal uses.
#pragma once

#include "core/library_versions.h"

namespace understudy::rehearsal {

LibraryVersions library_versions();

}  // namespace understudy::rehearsal
