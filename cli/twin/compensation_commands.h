// Sub-commands of `understudy` about controllers that are not this code: programs for them, and the twin in
// their place.
#pragma once

#include <CLI/App.hpp>

#include "cli/command.h"

namespace understudy::cli {

void add_compensate(CLI::App& app, Action& action);
void add_serve(CLI::App& app, Action& action);
void add_benchmark_compensation(CLI::App& benchmark, Action& action);

}  // namespace understudy::cli
