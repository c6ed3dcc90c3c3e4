#include "cli/expanded_xacro.h"

#include <sstream>

#include <fmt/format.h>

#include "calibration/plugin/child_process.h"
#include "core/error.h"
#include "core/file/output_file.h"
#include "core/text/shell_quoted.h"

namespace understudy::cli {
namespace fs = std::filesystem;
namespace {

constexpr double kPatience = 60;  // [s]
constexpr std::size_t kOutputMax = 64'000'000;

bool is_installed() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (::access((fs::path(folder) / "xacro").c_str(), X_OK) == 0) return true;
  return false;
}

/// Where ROS has its packages: `$(find NAME)` asks for them.
std::string environment() {
  std::string text;
  for (const char* name : {"ROS_PACKAGE_PATH", "ROS_ROOT", "ROS_DISTRO", "AMENT_PREFIX_PATH"})
    if (const char* value = std::getenv(name)) text += fmt::format("{}={} ", name, shell_quoted(value));
  return text;
}

std::string expand(const fs::path& file, const std::vector<std::string>& arguments) {
  std::string command = environment() + "xacro " + shell_quoted(fs::absolute(file).string());
  for (const std::string& argument : arguments) command += " " + shell_quoted(argument);
  calibration::ProcessLimits limits;
  limits.time = kPatience;
  limits.output = kOutputMax;
  const calibration::ProcessRun run = calibration::run_process(command, "", limits);
  if (!run.ok) throw InputError({file.string(), 0, 0}, "xacro " + run.failure);
  if (run.output.empty()) throw InputError({file.string(), 0, 0}, "xacro made nothing of it");
  return run.output;
}

}  // namespace

ExpandedXacro::ExpandedXacro(const fs::path& file, const std::vector<std::string>& arguments) {
  if (std::error_code error; !fs::is_regular_file(file, error))
    throw InputError({file.string(), 0, 0}, "is no file");
  if (!is_installed())
    throw InputError({file.string(), 0, 0},
                     "is a xacro file, and xacro is not installed: install it, which ROS brings, or "
                     "expand the file where it is (`xacro FILE -o arm.urdf`)");
  const std::string urdf = expand(file, arguments);
  path_ = folder_.path() / file.stem();
  write_file(path_, urdf);
}

}  // namespace understudy::cli
