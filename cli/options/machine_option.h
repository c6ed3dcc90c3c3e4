// The option --machine.
#pragma once

#include <string>

#include <CLI/App.hpp>

namespace understudy::cli {

/// Adds the option; what `machine` holds is the default.
CLI::Option* add_machine_option(CLI::App& command, std::string& machine);

}  // namespace understudy::cli
