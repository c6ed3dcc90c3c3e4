#include <clipper.hpp>

#include "toolpath/library_versions.h"

namespace understudy::toolpath {

std::string clipper_version() { return CLIPPER_VERSION; }

}  // namespace understudy::toolpath
