#pragma once

#include "cli/command.h"

namespace understudy::cli {

/// The sub-command of `calibrate`.
CLI::App* add_calibrate_bundle(CLI::App& calibrate, Action& action);

}  // namespace understudy::cli
