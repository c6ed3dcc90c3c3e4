#include "cli/options/machine_option.h"

namespace understudy::cli {

CLI::Option* add_machine_option(CLI::App& command, std::string& machine) {
  return command.add_option("--machine", machine, "name under models/ or a machine.yaml")
      ->capture_default_str();
}

}  // namespace understudy::cli
