// A whole print of many moves on the twin: memory, and whether time grows with the moves alone.
//   long_print_bench [MOVES ...]           default 25000 50000 100000; the limit of 0.6 GB is for 1000000
//   long_print_bench --write MOVES FILE    the program alone, to rehearse it with report and pictures
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <string>
#include <vector>

#include "bench/guarded.h"
#include "core/file/output_file.h"
#include "core/units.h"
#include "rehearsal/run_twin.h"
#include "sim/as_built/truth.h"
#include "toolpath/gcode/gcode.h"

namespace understudy {
namespace {

constexpr double kRow = 0.45, kLayer = 0.2, kPiece = 0.4, kWidth = 60;  // [mm]

/// Rows to and fro in layers, in pieces of 0.4 mm, every other layer the other way.
std::string program_of(std::size_t moves) {
  std::string text = "M109 S210\nM106 S255\nG0 X-30 Y-30 Z0.2\nG1 F3000\n";
  const double filament = kRow * kLayer * kPiece / 2.40528;  // of 1.75 mm
  double e = 0, along = 0, across = 0, z = kLayer;
  int way = 1;
  bool turned = false;
  char line[96];
  for (std::size_t i = 0; i < moves; ++i) {
    along += way * kPiece;
    if (along > kWidth || along < 0) {
      along -= way * kPiece;
      way = -way;
      across += kRow;
      if (across > kWidth) {
        across = 0;
        z += kLayer;
        turned = !turned;
      }
    }
    e += filament;
    const double x = (turned ? across : along) - kWidth / 2, y = (turned ? along : across) - kWidth / 2;
    std::snprintf(line, sizeof line, "G1 X%.3f Y%.3f Z%.3f E%.5f\n", x, y, z, e);
    text += line;
  }
  return text;
}

double memory_peak_mb() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == "VmHWM:") {
      double kilobytes = 0;
      status >> kilobytes;
      return kilobytes / 1024;
    }
  return 0;
}

void run(std::size_t moves) {
  rehearsal::TwinSetup setup;
  setup.machine = machine::load_machine("five-axis");
  setup.material = machine::load_material(setup.machine.process.material);
  toolpath::GcodeOptions options;
  options.X_WT_home = setup.machine.X_WB * setup.machine.X_BT_home;
  setup.program = toolpath::parse_gcode(program_of(moves), "generated", options);
  setup.as_built = sim::make_as_built(setup.machine, "nominal", 0);
  setup.truth = sim::true_description(setup.machine, setup.as_built);
  setup.engine = "quasistatic";
  const auto begin = std::chrono::steady_clock::now();
  const std::clock_t cpu = std::clock();
  rehearsal::RunOptions run;
  run.gap_control = control::GapControl::off;
  const auto result = rehearsal::run_twin(setup, run, {});
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const double used = static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC;
  const auto& laid = result.deposition;
  std::printf("%9zu  %8.0f  %7.1f  %8.1f  %5.2f  %8zu  %7.0f  %10.2e\n", moves, result.result.duration, wall,
              1e6 * wall / static_cast<double>(moves), used / wall, laid.beads, memory_peak_mb(),
              std::abs(laid.laid_volume + laid.column_volume - laid.extruded_volume) / laid.extruded_volume);
  std::fflush(stdout);
}

}  // namespace
}  // namespace understudy

int main(int argc, char** argv) {
  return understudy::bench::guarded("long_print_bench", [&] {
    if (argc == 4 && std::string(argv[1]) == "--write") {
      understudy::write_file(argv[3], understudy::program_of(std::strtoul(argv[2], nullptr, 10)));
      return 0;
    }
    std::vector<std::size_t> sizes;
    for (int i = 1; i < argc; ++i) sizes.push_back(std::strtoul(argv[i], nullptr, 10));
    if (sizes.empty()) sizes = {25'000, 50'000, 100'000};
    std::printf("    moves  print s   wall s  us a move  cores     beads  peak MB  volume lost\n");
    for (const std::size_t moves : sizes) understudy::run(moves);
    return 0;
  });
}
