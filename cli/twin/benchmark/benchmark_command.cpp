#include "cli/command.h"
#include "cli/twin/compensation_commands.h"

namespace understudy::cli {

void add_benchmark(CLI::App& app, Action& action) {
  auto* benchmark =
      app.add_subcommand("benchmark", "Algorithms against each other on problems whose truth is known");
  benchmark->require_subcommand(1);
  add_benchmark_calibration(*benchmark, action);
  add_benchmark_gap(*benchmark, action);
  add_benchmark_faults(*benchmark, action);
  add_benchmark_compensation(*benchmark, action);
}

}  // namespace understudy::cli
