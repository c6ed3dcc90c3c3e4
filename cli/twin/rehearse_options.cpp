#include "cli/twin/rehearse_options.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "cli/command.h"
#include "cli/options/dialect_options.h"
#include "cli/options/machine_option.h"
#include "cli/options/seed_option.h"
#include "cli/twin/registration_options.h"
#include "cli/twin/robot_options.h"
#include "core/error.h"
#include "rehearsal/request/fault_words.h"

namespace understudy::cli {
namespace {
namespace fs = std::filesystem;

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
  command
      .add_option("--depth-of-cut", surface.depth_of_cut_mm,
                  "mm: an end mill takes --intended out of a stock that is larger by this")
      ->check(CLI::Range(0.001, 100.))
      ->group("Surface of the print");
  command
      .add_option("--stock", surface.stock,
                  "the stock that is milled to --intended: an STL in mm, or a name under models/parts")
      ->excludes("--depth-of-cut")
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

void add_request(CLI::App& command, rehearsal::RehearsalRequest& request) {
  command
      .add_option("program", request.program,
                  "G-code, with the tool's orientation at each point, or KRL or RAPID")
      ->required();
  add_machine_option(command, request.machine);
  command.add_option(
      "--before", request.before,
      "the machine before its calibration, a name or a machine.yaml: the same print on the same "
      "twin, driven by that; the report compares tip errors");
  command
      .add_option("--home-axes", request.home_axes,
                  "positions of all axes at home, in mm and degrees: another posture of an arm than the "
                  "machine file's")
      ->delimiter(',')
      ->excludes("--before")
      ->group("Programs of other machines");
  command
      .add_option("--engine", request.engine,
                  "plant: mujoco (the reference), bullet (hexapods, and arms over a table that stands "
                  "still), quasistatic (fast)")
      ->capture_default_str();
  command
      .add_option("--fixture", request.fixture,
                  "the inserted part: an STL in mm, or a name under models/parts")
      ->check([](const std::string& word) { return word.empty() ? "is empty: leave the option out" : ""; });
  command.add_option("--material", request.material,
                     "filament: a name under models/materials or a file; the machine's own unless given");
  command.add_option(
      "--as-built", request.as_built,
      "the machine that stands there: the drawing (nominal), off by the tolerances of manufacture "
      "(manufactured) or those left after a calibration (sampled), or a file of as-built parameters; "
      "calibrated: what the calibration of --machine leaves open; without it calibrated where --machine "
      "has a calibration, else sampled");
  command.add_option("--seed", request.seed, "of the as-built errors and of all noise")
      ->check(seed_check())
      ->capture_default_str();
  command.add_option(
      "--gap-control", request.gap_control,
      "off; start: close the gap before each print move by laser and camera; continuous: and follow "
      "it along the path; start where the machine has them");
  auto* find = command
                   .add_flag("--register", request.registration.wanted,
                             "first find the part by laser and camera, and print where it stands")
                   ->group("Finding the part");
  add_registration_options(command, request.registration);
  for (const char* option : {"--pattern", "--places"}) command.get_option(option)->needs(find);
  command
      .add_option(
          "--part-pose", request.part_pose,
          "where the part stands, a .yaml that `understudy register` wrote: the program is moved there")
      ->excludes(find)
      ->group("Finding the part");
  add_tolerances(command, request);
  add_dialect_options(command, request.dialect);
  add_robot_options(command, request.dialect.robot);
  add_surface(command, request.surface);
  command
      .add_option("--max-time", request.max_time,
                  "seconds that the program may take at least; more is refused")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command.add_option("--record", request.record,
                     "file to write with all that goes through the machine's port, such as understudy drive "
                     "writes (docs/port-record.md)");
  command.add_flag("!--no-pictures", request.keep_scene,
                   "leave the drawings of machine and part out of the report");
}

/// Say what is written and where, or stand in the provenance of a record themselves.
constexpr std::array<std::string_view, 10> kOptionsLeftOut{
    "--out",   "--video", "--record", "--as-printed", "--no-pictures",
    "--quiet", "--json",  "--seed",   "--watch",      "--watch-port"};

/// Throws InputError where it is no command of `rehearse`, whose options `app` has.
void parse_command(CLI::App& app, const std::string& command_line) {
  std::vector<std::string> words = split_command_line(command_line);
  if (words.size() < 3 || words[1] != "rehearse")
    throw InputError("'" + command_line + "' is no command of understudy rehearse");
  words.erase(words.begin(), words.begin() + 2);
  std::reverse(words.begin(), words.end());  // as CLI11 takes them
  try {
    app.parse(words);
    check_numbers(app);
  } catch (const CLI::Error& error) {
    throw InputError("'" + command_line + "': " + error.what());
  }
}

/// Its name from the folder on, where it lies in it.
std::optional<fs::path> place_among(const std::string& file, const std::string& folder) {
  const auto whole = [](const fs::path& path) { return fs::absolute(path).lexically_normal(); };
  fs::path name = whole(file).lexically_relative(whole(fs::path(folder) / "."));
  if (name.empty() || *name.begin() == "..") return std::nullopt;
  return name;
}

}  // namespace

void add_rehearse_options(CLI::App& command, RehearseOptions& options) {
  add_request(command, options.request);
  command
      .add_option("--fault", options.faults,
                  "what goes wrong on the way, in the words of scenarios: '{fault: stall, axis: l3, at_s: 4, "
                  "for_s: 0.4}'; may be given several times (docs/faults.md)")
      ->allow_extra_args(false);
  command.add_option("--out", options.folder, "folder of results")->capture_default_str();
  command.add_option("--video", options.video,
                     "FILE.mp4, outside of --out: also a film of the run (understudy export video)");
  add_watch_options(command, options.watch, "the growing report");
  add_quiet_option(command, options.output, "no progress, and the verdict alone, in one line");
  add_json_option(command, options.output, "the summary");
}

rehearsal::RehearsalRequest RehearseOptions::with_faults() const {
  rehearsal::RehearsalRequest all = request;
  for (const std::string& words : faults) rehearsal::add_fault(words, all);
  return all;
}

RehearseOptions read_rehearse_command(const std::string& command_line) {
  RehearseOptions options;
  CLI::App app;
  add_rehearse_options(app, options);
  parse_command(app, command_line);
  return options;
}

std::map<std::string, std::string> rehearse_option_words(const std::string& command_line) {
  RehearseOptions options;
  CLI::App app;
  add_rehearse_options(app, options);
  parse_command(app, command_line);
  std::map<std::string, std::string> given;
  for (const CLI::Option* option : app.get_options())
    if (option->count() > 0 &&
        std::ranges::find(kOptionsLeftOut, option->get_name()) == kOptionsLeftOut.end())
      given[option->get_name()] = fmt::format("{}", fmt::join(option->results(), " "));
  return given;
}

bool is_among(const std::string& file, const std::string& folder) {
  return place_among(file, folder).has_value();
}

std::string among_results(const std::string& file, const std::string& folder, const std::string& working) {
  if (file.empty()) return file;
  const auto among = place_among(file, folder);
  if (!among) return file;
  const fs::path& name = *among;
  fs::create_directories((working / name).parent_path());
  return (working / name).string();
}

}  // namespace understudy::cli
