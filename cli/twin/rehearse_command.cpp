#include <filesystem>
#include <memory>
#include <set>
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/command.h"
#include "cli/machine_option.h"
#include "cli/progress.h"
#include "cli/seed_option.h"
#include "cli/twin/registration_options.h"
#include "core/file/output_file.h"
#include "core/file/output_folder.h"
#include "core/interrupt.h"
#include "rehearsal/findings/finding_groups.h"
#include "rehearsal/findings/verdict.h"
#include "rehearsal/rehearse.h"
#include "report/page/write_results.h"

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
  if (print.primed_mm > 0) fmt::print("; {:.1f} mm more pushed back after retractions", print.primed_mm);
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

void print_answer(const rehearsal::Record& record, const std::string& folder) {
  fmt::print("{}: {}\n", record.title, headline(grade_of(record)));
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
  if (record.calibration) print_calibration(*record.calibration);
  if (record.collision) print_clearance(*record.collision);
  if (record.sag && record.sag->strands > 0)
    fmt::print("  {} strands in air, {:.1f} mm in all, sag {:.0f} um at most\n", record.sag->strands,
               record.sag->unsupported_mm, record.sag->max_um);
  if (record.surface && record.surface->ra_um)
    fmt::print("  surface Ra {:.1f} um, Rz {:.1f} um\n", *record.surface->ra_um, *record.surface->rz_um);
  if (record.print) print_print(*record.print);
  fmt::print("report: {}\n", (std::filesystem::path(folder) / "report.html").string());
}

/// A file that shall lie in the folder of results is one of them, written where they are.
std::string among_results(const std::string& file, const std::string& folder, const OutputFolder& out) {
  namespace fs = std::filesystem;
  if (file.empty()) return file;
  const auto whole = [](const fs::path& path) { return fs::absolute(path).lexically_normal(); };
  const fs::path name = whole(file).lexically_relative(whole(fs::path(folder) / "."));
  if (name.empty() || *name.begin() == "..") return file;
  fs::create_directories((out.path() / name).parent_path());
  return (out.path() / name).string();
}

int rehearse(const rehearsal::RehearsalRequest& asked, const std::string& folder) {
  rehearsal::RehearsalRequest request = asked;
  request.command = command_line();
  OutputFolder out(folder);
  request.surface.as_printed = among_results(asked.surface.as_printed, folder, out);
  rehearsal::Record record;
  std::vector<report::Illustration> pictures;
  {
    ProgressLine line;
    record =
        rehearsal::rehearse(request, [&](double share, const std::string& what) { line.show(share, what); });
    line.show(1, "drawing");
    if (record.scene) pictures = report::draw_scene(*record.scene);
  }
  report::write_results(record, pictures, out.path());
  stop_if_interrupted();
  out.commit();
  print_answer(record, folder);
  return record.go ? kGood : kNo;
}

void add_tolerances(CLI::App& command, rehearsal::RehearsalRequest& request) {
  command
      .add_option("--tip-tolerance", request.tip_tolerance_mm,
                  "mm: a print whose tip is off by more is a no-go; without it the machine file's")
      ->check(CLI::PositiveNumber);
  command
      .add_option(
          "--orientation-tolerance", request.orientation_tolerance_deg,
          "degrees: a print whose tool is turned away by more is a no-go; without it the machine file's")
      ->check(CLI::PositiveNumber);
}

void add_dialect(CLI::App& command, rehearsal::DialectRequest& dialect) {
  command.add_option("--place", dialect.place_mm, "X,Y,Z in mm: where the program's origin stands")
      ->delimiter(',')
      ->group("Programs of other machines");
  command.add_option("--extruder-letter", dialect.extruder_letter, "letter of the filament's axis: E or A")
      ->capture_default_str()
      ->group("Programs of other machines");
  command.add_option("--b-sign", dialect.b_sign, "-1: the program counts B the other way round")
      ->check(CLI::IsMember({-1, 1}))
      ->capture_default_str()
      ->group("Programs of other machines");
  command.add_option("--c-sign", dialect.c_sign, "-1: the program counts C the other way round")
      ->check(CLI::IsMember({-1, 1}))
      ->capture_default_str()
      ->group("Programs of other machines");
  command
      .add_option(
          "--coordinates", dialect.coordinates,
          "what X Y Z mean beside B C: tip (on the work), machine (the slides), crossing (the slides of a "
          "machine whose turning axes cross at the program's origin)")
      ->group("Programs of other machines");
}

void add_surface(CLI::App& command, rehearsal::SurfaceRequest& surface) {
  command
      .add_option("--as-printed", surface.as_printed,
                  "write the printed part: FILE.stl, or FILE.ply with its "
                  "deviation from --intended as colour")
      ->group("Surface of the print");
  command
      .add_option("--intended", surface.intended,
                  "what the print was to become: an STL in mm, or a name "
                  "under models/parts")
      ->group("Surface of the print");
  command.add_option("--profile", surface.profile_mm, "x,y,z,x,y,z in mm: measure Ra and Rz along this line")
      ->delimiter(',')
      ->expected(6)
      ->group("Surface of the print");
  command
      .add_option("--probe", surface.probe, "x,y,z: the direction in which the line looks for the surface")
      ->delimiter(',')
      ->expected(3)
      ->group("Surface of the print");
}

}  // namespace

void add_rehearse(CLI::App& app, Action& action) {
  auto request = std::make_shared<rehearsal::RehearsalRequest>();
  auto folder = std::make_shared<std::string>("rehearsal");
  auto* command = app.add_subcommand("rehearse", "Print a program on the twin and say go or no-go");
  command->add_option("program", request->program, "G-code, with the tool's orientation at each point")
      ->required();
  add_machine_option(*command, request->machine);
  command->add_option(
      "--before", request->before,
      "the machine before its calibration, a name or a machine.yaml: the same print on the same "
      "twin, driven by that; the report compares tip errors");
  command
      ->add_option("--engine", request->engine,
                   "plant: mujoco (the reference), bullet (hexapod, arm), quasistatic (fast)")
      ->capture_default_str();
  command
      ->add_option("--fixture", request->fixture,
                   "the inserted part: an STL in mm, or a name under models/parts")
      ->check([](const std::string& word) { return word.empty() ? "is empty: leave the option out" : ""; });
  command->add_option("--material", request->material,
                      "filament: a name under models/materials or a file; the machine's own unless given");
  command->add_option(
      "--as-built", request->as_built,
      "the machine that stands there: the drawing (nominal), off by the tolerances of manufacture "
      "(manufactured) or those left after a calibration (sampled), or a file of as-built parameters; "
      "calibrated: what the calibration of --machine leaves open; without it calibrated where --machine "
      "has a calibration, else sampled");
  command->add_option("--seed", request->seed, "of the as-built errors and of all noise")
      ->check(seed_check())
      ->capture_default_str();
  command->add_option(
      "--gap-control", request->gap_control,
      "off; start: close the gap before each print move by laser and camera; continuous: and follow "
      "it along the path; start where the machine has them");
  auto* find = command
                   ->add_flag("--register", request->registration.wanted,
                              "first find the part by laser and camera, and print where it stands")
                   ->group("Finding the part");
  add_registration_options(*command, request->registration);
  for (const char* option : {"--pattern", "--places"}) command->get_option(option)->needs(find);
  add_tolerances(*command, *request);
  add_dialect(*command, request->dialect);
  add_surface(*command, request->surface);
  command
      ->add_option("--max-time", request->max_time,
                   "seconds that the program may take at least; more is refused")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_flag("!--no-pictures", request->keep_scene,
                    "leave the drawings of machine and part out of the report");
  command->add_option("--out", *folder, "folder of results")->capture_default_str();
  command->callback([=, &action] { action = [=] { return rehearse(*request, *folder); }; });
}

}  // namespace understudy::cli
