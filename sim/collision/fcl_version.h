// The version of the library that measures distances between bodies.
#pragma once

#include <string>

namespace understudy::sim {

std::string fcl_version();

}  // namespace understudy::sim
