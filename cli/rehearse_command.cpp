#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/command.h"
#include "cli/progress.h"
#include "core/interrupt.h"
#include "core/output_file.h"
#include "rehearsal/rehearse.h"
#include "rehearsal/report.h"

namespace understudy::cli {
namespace {

constexpr std::size_t kFindingsShown = 10;

void print_answer(const rehearsal::Record& record, const std::string& folder) {
  fmt::print("{}: {}\n", record.title, record.go ? "GO" : "NO-GO");
  std::size_t shown = 0;
  for (const auto& finding : record.findings) {
    if (shown++ == kFindingsShown) {
      fmt::print("  ... and {} more in the report\n", record.findings.size() - kFindingsShown);
      break;
    }
    fmt::print("  {} {}{}: {}\n", finding.severity == rehearsal::Severity::error ? "error  " : "warning",
               finding.kind, finding.gcode_line > 0 ? fmt::format(" (line {})", finding.gcode_line) : "",
               finding.message);
  }
  if (record.gap) {
    const auto& gap = *record.gap;
    fmt::print("  gap at the start {:.3f} mm", gap.start_mm);
    if (gap.open_loop_start_mm) fmt::print(" (without gap control {:.3f} mm)", *gap.open_loop_start_mm);
    fmt::print(", along the path {:.3f}..{:.3f} mm, {:.1f} % of it in {:.1f}-{:.1f} mm\n", gap.path_min_mm,
               gap.path_max_mm, 100 * gap.in_band_fraction, record.gap_accepted_min_mm,
               record.gap_accepted_max_mm);
  }
  if (record.accuracy)
    fmt::print("  tip error {:.0f} um RMS, {:.0f} um at most\n", record.accuracy->tip_rms_um,
               record.accuracy->tip_max_um);
  if (record.collision)
    fmt::print("  smallest clearance {:.2f} mm over {} checks\n", record.collision->min_clearance_mm,
               record.collision->checks);
  if (record.print) fmt::print("  print time {:.1f} s\n", record.print->duration_s);
  fmt::print("report: {}\n", (std::filesystem::path(folder) / "report.html").string());
}

int rehearse(const rehearsal::RehearsalRequest& asked, const std::string& folder) {
  rehearsal::RehearsalRequest request = asked;
  request.command = command_line();
  OutputFolder out(folder, "summary.json");
  rehearsal::Record record;
  {
    ProgressLine line;
    record =
        rehearsal::rehearse(request, [&](double share, const std::string& what) { line.show(share, what); });
  }
  rehearsal::write_results(record, out.path());
  stop_if_interrupted();
  out.commit();
  print_answer(record, folder);
  return record.go ? kGood : kNo;
}

}  // namespace

void add_rehearse(CLI::App& app, Action& action) {
  auto request = std::make_shared<rehearsal::RehearsalRequest>();
  auto folder = std::make_shared<std::string>("rehearsal");
  auto* command = app.add_subcommand("rehearse", "Print a program on the twin and say go or no-go");
  command->add_option("program", request->program, "G-code, with the tool's orientation at each point")
      ->required();
  command->add_option("--machine", request->machine, "name under models/ or a machine.yaml")
      ->capture_default_str();
  command->add_option("--engine", request->engine, "plant: mujoco (the reference), bullet (hexapod, arm), quasistatic (fast)")
      ->capture_default_str();
  command->add_option("--fixture", request->fixture,
                      "the inserted part: an STL in mm, or a name under models/parts");
  command
      ->add_option("--as-built", request->as_built,
                   "the twin's errors: nominal, sampled (left after calibration), manufactured, or a file of "
                   "as-built parameters")
      ->capture_default_str();
  command->add_option("--seed", request->seed, "of the as-built errors and of all noise")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command
      ->add_option("--gap-control", request->gap_control,
                   "off, or start: close the gap before each print move by laser and camera; start where the "
                   "machine has them");
  command->add_option("--out", *folder, "folder of results")->capture_default_str();
  command->callback([=, &action] { action = [=] { return rehearse(*request, *folder); }; });
}

}  // namespace understudy::cli
