// The versions of the libraries of this room. Each is told where its headers may be seen.
#pragma once

#include <string>

namespace understudy::toolpath {

std::string clipper_version();   ///< planners/
std::string json_version();      ///< lattice/
std::string lib2geom_version();  ///< svg/

}  // namespace understudy::toolpath
