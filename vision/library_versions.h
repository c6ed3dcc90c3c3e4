// The versions of the libraries of this room.
#pragma once

#include "core/library_versions.h"

namespace understudy::vision {

LibraryVersions library_versions();

}  // namespace understudy::vision
