// The versions of all libraries that the software of the real machine uses.
#pragma once

#include <string>

#include "core/library_versions.h"

namespace understudy::control {

LibraryVersions library_versions();

std::string boost_version();  ///< told in registration/, which may see its headers

}  // namespace understudy::control
