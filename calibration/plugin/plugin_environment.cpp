#include "calibration/plugin/plugin_environment.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace understudy::calibration {
namespace {

constexpr std::array<std::string_view, 25> kNames{"PATH",
                                                  "HOME",
                                                  "USER",
                                                  "LOGNAME",
                                                  "SHELL",
                                                  "LANG",
                                                  "LANGUAGE",
                                                  "TZ",
                                                  "TMPDIR",
                                                  "LD_LIBRARY_PATH",
                                                  "PYTHONPATH",
                                                  "PYTHONHOME",
                                                  "VIRTUAL_ENV",
                                                  "PYENV_ROOT",
                                                  "PYENV_VERSION",
                                                  "R_HOME",
                                                  "R_LIBS",
                                                  "R_LIBS_USER",
                                                  "JULIA_LOAD_PATH",
                                                  "JULIA_DEPOT_PATH",
                                                  "JAVA_HOME",
                                                  "CONDA_PREFIX",
                                                  "JULIA_PROJECT",
                                                  "MKL_NUM_THREADS",
                                                  "OPENBLAS_NUM_THREADS"};
constexpr std::array<std::string_view, 2> kBeginnings{"LC_", "OMP_"};

}  // namespace

std::vector<std::string> plugin_environment() {
  std::vector<std::string> kept;
  for (char** entry = environ; entry && *entry; ++entry) {
    const std::string_view text = *entry;
    const std::string_view name = text.substr(0, text.find('='));
    const auto begins = [&](std::string_view beginning) { return name.starts_with(beginning); };
    if (std::ranges::find(kNames, name) != kNames.end() || std::ranges::any_of(kBeginnings, begins))
      kept.emplace_back(text);
  }
  return kept;
}

}  // namespace understudy::calibration
