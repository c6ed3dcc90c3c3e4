#include <mujoco/mujoco.h>

#include "sim/plant/engine_versions.h"

namespace understudy::sim {

std::string mujoco_version() { return mj_versionString(); }

}  // namespace understudy::sim
