#include "sim/collision/fcl_version.h"

#include <fcl/config.h>

#include "core/library_versions.h"

namespace understudy::sim {

std::string fcl_version() { return loaded_version("libfcl", FCL_VERSION); }

}  // namespace understudy::sim
