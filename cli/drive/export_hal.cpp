#include <memory>
#include <string>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/options/machine_option.h"
#include "core/file/output_file.h"
#include "core/file/output_folder.h"
#include "drivers/hal/hal_files.h"
#include "machine/description.h"

namespace understudy::cli {
namespace {

struct HalRequest {
  std::string machine, output;
  drivers::HalOptions options;
  double watchdog_ms = 50, following_ms = 5;
};

int export_hal(HalRequest r) {
  const auto machine = machine::load_machine(r.machine);
  r.options.watchdog = r.watchdog_ms * 1e-3;
  r.options.following = r.following_ms * 1e-3;
  const drivers::HalSettings settings = drivers::hal_settings(machine, r.options);
  OutputFolder folder(r.output);
  for (const drivers::HalFile& file : drivers::hal_files(settings))
    write_file(folder.path() / file.name, file.text);
  folder.commit();
  for (const std::string& line : drivers::too_fast_for_software(settings))
    fmt::print(stderr, "understudy: note: {}\n", line);
  fmt::print("{}\n", r.output);
  return kGood;
}

}  // namespace

void add_export_hal(CLI::App& command, Action& action) {
  auto request = std::make_shared<HalRequest>();
  auto* hal =
      command.add_subcommand("hal", "A configuration of LinuxCNC's HAL that takes this program's setpoints");
  hal->footer(
      "Example: understudy export hal --machine hexapod -o hexapod-hal && cd hexapod-hal && halrun -I -f "
      "machine.hal\n"
      "The folder's README.md says which pins a real machine changes (docs/linuxcnc.md).");
  add_machine_option(*hal, request->machine)->required();
  hal->add_option("--base-period", request->options.base_period_us,
                  "microseconds between two steps of the software step generators")
      ->capture_default_str();
  hal->add_option("--watchdog", request->watchdog_ms,
                  "milliseconds without a setpoint until the machine stops")
      ->capture_default_str();
  hal->add_option(
         "--following", request->following_ms,
         "milliseconds by which a drive may be behind at full speed; 500 for a trial without a real-time "
         "kernel")
      ->capture_default_str();
  hal->add_option("-o,--output", request->output, "folder to write")->required();
  hal->callback([=, &action] { action = [=] { return export_hal(*request); }; });
}

}  // namespace understudy::cli
