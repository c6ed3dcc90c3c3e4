// The versions of the engines behind the plants, each told where its headers may be seen.
#pragma once

#include <string>

namespace understudy::sim {

std::string mujoco_version();  ///< mujoco/
std::string bullet_version();  ///< bullet/

}  // namespace understudy::sim
