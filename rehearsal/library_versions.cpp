#include "rehearsal/library_versions.h"

#include "control/library_versions.h"
#include "renderer/library_versions.h"
#include "sim/collision/fcl_version.h"
#include "sim/plant/engine_versions.h"

namespace understudy::rehearsal {

LibraryVersions library_versions() {
  LibraryVersions all{
      {"Bullet", sim::bullet_version()}, {"FCL", sim::fcl_version()}, {"MuJoCo", sim::mujoco_version()}};
  all.merge(control::library_versions());
  all.merge(renderer::library_versions());
  return all;
}

}  // namespace understudy::rehearsal
