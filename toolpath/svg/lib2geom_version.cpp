#include "toolpath/library_versions.h"

namespace understudy::toolpath {

std::string lib2geom_version() { return UNDERSTUDY_LIB2GEOM_VERSION; }

}  // namespace understudy::toolpath
