#include <memory>
#include <string>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/options/machine_option.h"
#include "core/file/output_file.h"
#include "core/file/output_folder.h"
#include "drivers/hal/linuxcnc_files.h"
#include "machine/description.h"

namespace understudy::cli {
namespace {

struct LinuxcncRequest {
  std::string machine, output;
};

int export_linuxcnc(const LinuxcncRequest& r) {
  const auto files = drivers::linuxcnc_files(machine::load_machine(r.machine));
  OutputFolder folder(r.output);
  for (const drivers::HalFile& file : files) write_file(folder.path() / file.name, file.text);
  folder.commit();
  fmt::print("{}\n", r.output);
  return kGood;
}

}  // namespace

void add_export_linuxcnc(CLI::App& command, Action& action) {
  auto request = std::make_shared<LinuxcncRequest>();
  auto* linuxcnc = command.add_subcommand(
      "linuxcnc",
      "A configuration of LinuxCNC with its own planner and hexapod kinematics, driven by linuxcncrsh");
  linuxcnc->footer(
      "Example: understudy export linuxcnc --machine hexapod -o hexapod-linuxcnc && cd hexapod-linuxcnc && "
      "linuxcnc "
      "machine.ini\n"
      "The folder's README.md says which pins a real machine changes (docs/linuxcnc.md).");
  add_machine_option(*linuxcnc, request->machine)->required();
  linuxcnc->add_option("-o,--output", request->output, "folder to write")->required();
  linuxcnc->callback([=, &action] { action = [=] { return export_linuxcnc(*request); }; });
}

}  // namespace understudy::cli
