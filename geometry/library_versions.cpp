#include "geometry/library_versions.h"

#include <assimp/version.h>
#include <fmt/format.h>

namespace understudy::geometry {

LibraryVersions library_versions() {
  return {{"assimp", fmt::format("{}.{}.{}", aiGetVersionMajor(), aiGetVersionMinor(), aiGetVersionPatch())}};
}

}  // namespace understudy::geometry
