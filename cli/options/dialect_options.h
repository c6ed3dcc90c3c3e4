// The options that say how a program of another machine is read.
#pragma once

#include <CLI/App.hpp>

#include "control/program/dialect_request.h"

namespace understudy::cli {

/// --temperature, --nozzle and --layer, for programs that do not say them.
void add_process_options(CLI::App& command, control::DialectRequest& dialect);

/// --ignore and --relative-extrusion.
void add_reading_options(CLI::App& command, control::DialectRequest& dialect);

/// Of those, how a program is read and where it stands.
void add_dialect_options(CLI::App& command, control::DialectRequest& dialect);

}  // namespace understudy::cli
