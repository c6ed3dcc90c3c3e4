#include <LinearMath/btScalar.h>
#include <fmt/format.h>

#include "sim/plant/engine_versions.h"

namespace understudy::sim {

std::string bullet_version() { return fmt::format("{}.{}", btGetVersion() / 100, btGetVersion() % 100); }

}  // namespace understudy::sim
