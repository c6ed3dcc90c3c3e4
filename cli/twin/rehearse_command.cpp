#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/command.h"
#include "cli/progress.h"
#include "cli/twin/export_video.h"
#include "cli/twin/registration_options.h"
#include "cli/twin/rehearse_into.h"
#include "cli/twin/rehearse_options.h"
#include "cli/twin/replay_option.h"
#include "cli/watch/watched_run.h"
#include "core/error.h"
#include "core/file/output_file.h"
#include "core/file/output_folder.h"
#include "core/file/read_file.h"
#include "core/interrupt.h"
#include "rehearsal/findings/finding_groups.h"
#include "rehearsal/findings/verdict.h"
#include "rehearsal/program/asked_path.h"
#include "rehearsal/rehearse.h"
#include "report/page/live_record.h"
#include "report/page/write_results.h"
#include "report/summary_json.h"
#include "toolpath/robot/robot_program.h"

namespace understudy::cli {
namespace {

constexpr std::size_t kGroupsShown = 10;

void print_calibration(const rehearsal::CalibrationFigures& figures) {
  fmt::print("  tip error without gap control {:.0f} um RMS, {:.0f} um at most", figures.after.tip_rms_um,
             figures.after.tip_max_um);
  if (figures.before)
    fmt::print("; before calibration {:.0f} um RMS, {:.0f} um at most", figures.before->tip_rms_um,
               figures.before->tip_max_um);
  else if (!figures.not_run_before.empty())
    fmt::print("; before calibration the program could not run: {}", figures.not_run_before);
  fmt::print("\n");
}

void print_print(const rehearsal::PrintFigures& print) {
  fmt::print("  print time {:.1f} s\n", print.duration_s);
  if (print.extruded_mm <= 0) return;
  fmt::print("  filament fed {:.1f} mm: {:.1f} mm printed, {:.1f} mm purged, {:.1f} mm missing",
             print.extruded_mm, print.printed_mm, print.purged_mm, print.missing_mm);
  if (print.primed_mm > 0)
    fmt::print("; beside that, retractions drew {:.1f} mm back and pushed them forward again",
               print.primed_mm);
  fmt::print("\n");
}

void print_removal(const rehearsal::RemovalFigures& removal) {
  fmt::print(
      "  milled {:.1f} mm3 off {:.1f} % of the part; left over {:.0f} um on the mean, {:.0f} um at 95 %, "
      "{:.0f} um at most",
      removal.volume_mm3, 100 * removal.finished_fraction, removal.left_over_mean_um,
      removal.left_over_p95_um, removal.left_over_max_um);
  if (removal.gouge_um > 0)
    fmt::print("; {:.0f} um deep into the part, at ({:.2f}, {:.2f}, {:.2f}) mm, line {}", removal.gouge_um,
               removal.gouge_mm[0], removal.gouge_mm[1], removal.gouge_mm[2], removal.gouge_line);
  fmt::print("\n");
}

void print_clearance(const rehearsal::CollisionFigures& figures) {
  const auto distance = [](double mm) {
    return mm < 0 ? fmt::format("{:.3f} mm deep", -mm) : fmt::format("{:.3f} mm", mm);
  };
  if (figures.nozzle_clearance_mm)
    fmt::print("  nozzle to what it prints on: least {}\n", distance(*figures.nozzle_clearance_mm));
  if (figures.min_clearance_mm)
    fmt::print("  all else: least clearance {} ({}), {} checks\n", distance(*figures.min_clearance_mm),
               figures.closest, figures.checks);
}

void print_findings(const std::vector<rehearsal::FindingGroup>& groups) {
  std::size_t shown = 0;
  std::set<std::string> advised;  // six struts that are too short ask for one remedy
  for (const auto& group : groups) {
    if (shown++ == kGroupsShown) {
      fmt::print("  ... and {} more kinds of finding in the report\n", groups.size() - kGroupsShown);
      return;
    }
    const std::string extent = extent_of(group);
    fmt::print("  {} {}{}: {}\n", group.worst.severity == rehearsal::Severity::error ? "error  " : "warning",
               group.worst.kind, extent.empty() ? "" : " (" + extent + ")", group.worst.message);
    if (!group.advice.empty() && advised.insert(group.advice).second)
      fmt::print("          what to do: {}\n", group.advice);
  }
}

/// Ahead of all figures: they are not those of the whole program.
void print_passed_over(const std::vector<std::pair<int, int>>& lines) {
  if (lines.empty()) return;
  std::string text;
  for (const auto& [first, last] : lines)
    text += (text.empty() ? "" : ", ") +
            (last > first ? fmt::format("{} to {}", first, last) : fmt::format("{}", first));
  fmt::print("  passed over, so that all of the following is about the program without it: {} {}\n",
             text.find_first_of(", ") == std::string::npos ? "line" : "lines", text);
}

void print_verdict(const rehearsal::Record& record) {
  fmt::print("{}: {}\n", record.title, headline(grade_of(record)));
}

void print_answer(const rehearsal::Record& record, const std::string& original, const std::string& folder) {
  print_verdict(record);
  print_passed_over(record.passed_over);
  if (record.placement)
    fmt::print("  placed by {}: margin {:.3f} ({})\n", record.placement->words, record.placement->margin,
               record.placement->least);
  print_findings(rehearsal::group_findings(record));
  if (record.registration) print_registration(*record.registration);
  if (record.gap) {
    const auto& gap = *record.gap;
    fmt::print("  gap at the start {:.3f} mm", gap.start_mm);
    if (gap.open_loop_start_mm) fmt::print(" (without gap control {:.3f} mm)", *gap.open_loop_start_mm);
    fmt::print(", along the path {:.3f}..{:.3f} mm, {:.1f} % of it in {:.1f}-{:.1f} mm\n", gap.path_min_mm,
               gap.path_max_mm, 100 * gap.in_band_fraction, record.gap_accepted_min_mm,
               record.gap_accepted_max_mm);
  }
  if (record.accuracy)
    fmt::print("  tip error {:.0f} um RMS, {:.0f} um at most; {:g} um are accepted\n",
               record.accuracy->tip_rms_um, record.accuracy->tip_max_um, 1e3 * record.tip_tolerance_mm);
  if (record.accuracy && !original.empty())
    fmt::print("  tip error against {}, which it was compensated from: {:.0f} um RMS, {:.0f} um at most\n",
               original, record.accuracy->tip_rms_um, record.accuracy->tip_max_um);
  if (record.calibration) print_calibration(*record.calibration);
  if (record.collision) print_clearance(*record.collision);
  if (record.sag && record.sag->strands > 0)
    fmt::print("  {} strands in air, {:.1f} mm in all, sag {:.0f} um at most\n", record.sag->strands,
               record.sag->unsupported_mm, record.sag->max_um);
  if (record.surface && record.surface->ra_um)
    fmt::print("  surface Ra {:.1f} um, Rz {:.1f} um\n", *record.surface->ra_um, *record.surface->rz_um);
  if (record.removal) print_removal(*record.removal);
  if (record.print) print_print(*record.print);
  fmt::print("report: {}\n", (std::filesystem::path(folder) / "report.html").string());
}

/// Where its name does not tell that the program is a robot's.
void print_language(std::FILE* to, const std::string& program) {
  std::error_code none;
  if (toolpath::has_robot_ending(program) || !std::filesystem::is_regular_file(program, none)) return;
  if (const auto language = toolpath::robot_language(program, read_file(program)))
    fmt::print(to, "{} is read as {}, as its content tells\n", program, to_string(*language));
}

void tell(const rehearsal::Record& record, const RehearseOptions& asked, const std::string& program) {
  if (!asked.output.quiet) print_language(asked.output.json ? stderr : stdout, program);
  if (asked.output.json)
    fmt::print("{}", report::summary_json(record));
  else if (asked.output.quiet)
    print_verdict(record);
  else
    print_answer(record, rehearsal::original_of(program), asked.folder);
}

/// What lies in the folder of results is one of them, and a film is none: it is made from them.
void check_film(const RehearseOptions& asked) {
  if (asked.video.empty()) return;
  if (!asked.request.keep_scene)
    throw InputError("--video needs the drawings that --no-pictures leaves out: leave one of them out");
  if (is_among(asked.video, asked.folder))
    throw InputError(fmt::format("--video {} lies in the folder of results {}: name a place outside of it",
                                 asked.video, asked.folder));
  check_video(asked.video);
}

/// Of results that are there: an interrupt costs the film alone.
void write_film(const rehearsal::Record& record, const RehearseOptions& asked) {
  if (record.trace.empty()) {
    fmt::print(stderr, "understudy: note: nothing was simulated: {} is not written\n", asked.video);
    return;
  }
  const report::Video film = video_of(asked.folder, {}, asked.output.quiet);
  write_file(asked.video, film.bytes);
  if (!asked.output.quiet && !asked.output.json) fmt::print("video: {} ({})\n", asked.video, film.codec);
}

int rehearse(const RehearseOptions& asked) {
  rehearsal::RehearsalRequest request = asked.with_faults();
  request.command = command_line();
  check_film(asked);
  OutputFolder out(asked.folder);
  request.surface.as_printed = among_results(request.surface.as_printed, asked.folder, out.path());
  std::optional<WatchedRun> watched;
  if (asked.watch.watch) watched.emplace(asked.watch.port);
  const rehearsal::Record record =
      rehearse_into(request, out.path(), asked.output.quiet, watched ? &watched->record : nullptr);
  stop_if_interrupted();
  out.commit();
  if (watched)
    watched->server.finish(read_file((std::filesystem::path(asked.folder) / "report.html").string()));
  tell(record, asked, request.program);
  if (!asked.video.empty()) write_film(record, asked);
  return record.go ? kGood : kNo;
}

}  // namespace

rehearsal::Record rehearse_into(const rehearsal::RehearsalRequest& request,
                                const std::filesystem::path& folder, bool quiet, report::LiveRecord* live) {
  ProgressLine line(!quiet);
  const auto show = [&](double share, const std::string& what) {
    line.show(share, what);
    if (live) live->progress(share, what);
  };
  rehearsal::Record record = rehearsal::rehearse(request, show, live);
  show(1, "drawing");
  report::write_results(record, report::pictures_of(record), folder);
  return record;
}

void add_rehearse(CLI::App& app, Action& action) {
  auto options = std::make_shared<RehearseOptions>();
  auto replay = std::make_shared<ReplayOptions>();
  auto* command = app.add_subcommand("rehearse", "Print a program on the twin and say go or no-go");
  add_rehearse_options(*command, *options);
  add_replay_options(*command, *replay);
  command->callback([=, &action] {
    if (replay->record.empty() && options->request.program.empty()) throw CLI::RequiredError("program");
    action = [=] {
      return replay->record.empty() ? rehearse(*options) : run_replay(*command, *options, *replay);
    };
  });
}

}  // namespace understudy::cli
