// Stands for twin_commands.cpp, export_mjcf.cpp, export_glb.cpp, export_video.cpp and drive_watch.cpp in the
// build without the twin.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/command.h"
#include "cli/doctor.h"
#include "cli/drive_watch.h"
#include "cli/export_video_command.h"
#include "control/library_versions.h"
#include "core/error.h"

namespace understudy::cli {

void add_twin_commands(CLI::App&, Action&) {}
void add_export_mjcf(CLI::App&, Action&) {}
void add_export_trace(CLI::App&, Action&) {}
void add_export_video(CLI::App&, Action&) {}
void add_export_glb(CLI::App&, Action&) {}

std::unique_ptr<DriveWatch> watch_drive(const machine::MachineDescription&, const std::string&, int) {
  throw InputError("--watch: this build is without the twin, and has no page to show");
}

std::vector<std::string> left_out_commands() {
  return {"rehearse",  "inspect",       "pose",      "place",        "verify",      "register",
          "scenario",  "sweep",         "campaign",  "sample-poses", "sample-gaps", "render",
          "workspace", "repeatability", "benchmark", "schema",       "compensate",  "serve"};
}

LibraryVersions library_versions_of_rooms() { return control::library_versions(); }

std::vector<HealthCheck> twin_self_test() {
  return {{"twin", true,
           fmt::format("left out of this build, and with it {}, export mjcf, export glb",
                       fmt::join(left_out_commands(), ", "))}};
}

}  // namespace understudy::cli
