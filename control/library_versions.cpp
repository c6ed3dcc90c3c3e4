#include "control/library_versions.h"

#include "geometry/library_versions.h"
#include "machine/library_versions.h"
#include "toolpath/library_versions.h"
#include "vision/library_versions.h"

namespace understudy::control {

LibraryVersions library_versions() {
  LibraryVersions all{{"Boost", boost_version()},
                      {"Clipper", toolpath::clipper_version()},
                      {"lib2geom", toolpath::lib2geom_version()},
                      {"nlohmann-json", toolpath::json_version()}};
  all.merge(understudy::library_versions());
  all.merge(geometry::library_versions());
  all.merge(machine::library_versions());
  all.merge(vision::library_versions());
  return all;
}

}  // namespace understudy::control
