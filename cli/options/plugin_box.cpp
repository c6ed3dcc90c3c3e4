#include "cli/options/plugin_box.h"

#include <cstdio>
#include <string>

#include <fmt/format.h>

#include "calibration/plugin/box.h"

namespace understudy::cli {

void warn_of_box(bool runs_plugins) {
  const std::string warning = runs_plugins ? calibration::box_warning() : "";
  if (!warning.empty()) fmt::print(stderr, "{}\n", warning);
}

}  // namespace understudy::cli
