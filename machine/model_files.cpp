#include "machine/model_files.h"

#include <algorithm>
#include <cstdlib>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "machine/description.h"

namespace understudy::machine {
namespace fs = std::filesystem;
namespace {

constexpr const char* kFileName = "machine.yaml";

bool looks_like_path(const std::string& text) {
  return text.find('/') != std::string::npos || text.ends_with(".yaml") || text.ends_with(".yml") ||
         text == "." || text == "..";
}

}  // namespace

fs::path models_folder() {
  if (const char* set = std::getenv("UNDERSTUDY_MODELS"); set && *set) return set;
  return shipped_models_folder();
}

fs::path shipped_models_folder() {
  std::error_code error;
  const fs::path executable = fs::read_symlink("/proc/self/exe", error);
  const fs::path installed = (executable.parent_path() / "../share/understudy/models").lexically_normal();
  if (!fs::is_directory(installed, error) && fs::is_directory(UNDERSTUDY_SOURCE_MODELS, error))
    return UNDERSTUDY_SOURCE_MODELS;
  return installed;
}

std::vector<std::string> machine_names() {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(models_folder(), error)) {
    std::error_code ignored;
    if (fs::is_regular_file(entry.path() / kFileName, ignored))
      names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

fs::path find_model(const std::string& name_or_path) {
  if (name_or_path.empty()) throw InputError("the machine has no name");
  std::error_code error;
  if (looks_like_path(name_or_path)) {
    const fs::path path = name_or_path;
    return fs::is_directory(path, error) ? path / kFileName : path;
  }
  const std::vector<std::string> names = machine_names();
  if (std::find(names.begin(), names.end(), name_or_path) != names.end())
    return models_folder() / name_or_path / kFileName;
  // A folder or file in the working directory is meant only when no shipped model has that name.
  if (fs::is_regular_file(fs::path(name_or_path) / kFileName, error))
    return fs::path(name_or_path) / kFileName;
  if (fs::is_regular_file(name_or_path, error)) return name_or_path;
  if (names.empty())
    throw InputError(fmt::format("unknown machine '{}': no machine is described in {}", name_or_path,
                                 models_folder().string()));
  const std::string near = nearest_word(name_or_path, names);
  throw InputError(fmt::format("unknown machine '{}'{}; known machines: {}", name_or_path,
                               near.empty() ? "" : fmt::format(", did you mean '{}'?", near),
                               fmt::join(names, ", ")));
}

}  // namespace understudy::machine
