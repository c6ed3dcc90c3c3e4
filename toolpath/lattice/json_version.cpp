#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "toolpath/library_versions.h"

namespace understudy::toolpath {

std::string json_version() {
  return fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                     NLOHMANN_JSON_VERSION_PATCH);
}

}  // namespace understudy::toolpath
