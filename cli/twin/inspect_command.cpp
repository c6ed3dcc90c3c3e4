#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "cli/command.h"
#include "cli/options/dialect_options.h"
#include "cli/options/machine_option.h"
#include "cli/twin/inspect_robot.h"
#include "core/error.h"
#include "core/quantile.h"
#include "core/units.h"
#include "machine/default_machine.h"
#include "rehearsal/inspection/inspect.h"
#include "rehearsal/inspection/place_on_table.h"
#include "rehearsal/placement/misfit.h"
#include "rehearsal/program/told_filament.h"

namespace understudy::cli {
namespace {

constexpr std::size_t kReadingsShown = 4;

std::string place(const Vec3& p) {
  return fmt::format("({:.2f}, {:.2f}, {:.2f})", to_mm(p.x()), to_mm(p.y()), to_mm(p.z()));
}

void print_layers(const toolpath::ProgramSummary& summary) {
  if (summary.first_layer == 0) return;
  fmt::print("  layers: the first {:.3f} mm above z = 0", to_mm(summary.first_layer));
  const auto& heights = summary.layer_heights;
  if (!heights.empty())
    fmt::print(", then {} of {:.3f} mm ({:.3f} to {:.3f})", heights.size(), to_mm(quantile(heights, 0.5)),
               to_mm(quantile(heights, 0)), to_mm(quantile(heights, 1)));
  fmt::print("\n");
}

void print_beads(const toolpath::ProgramSummary& summary) {
  if (summary.area_p50 <= 0) return;
  fmt::print("  beads: {:.4f} mm2 in section ({:.4f} to {:.4f} for 90 % of their length)",
             1e6 * summary.area_p50, 1e6 * summary.area_p5, 1e6 * summary.area_p95);
  if (!summary.layer_heights.empty()) {
    const double height = quantile(summary.layer_heights, 0.5);
    fmt::print(": {:.2f} mm wide in a layer of {:.2f} mm",
               to_mm(toolpath::bead_width(summary.area_p50, height)), to_mm(height));
  }
  fmt::print("\n");
}

/// By their share of the printed path.
void print_features(const std::map<std::string, double>& lengths) {
  if (lengths.empty()) return;
  double total = 0;
  std::vector<std::pair<double, std::string>> features;
  for (const auto& [type, length] : lengths) {
    total += length;
    features.emplace_back(length, type);
  }
  std::sort(features.rbegin(), features.rend());
  std::vector<std::string> words;
  for (const auto& [length, type] : features)
    words.push_back(fmt::format("{} {:.1f} %", type, total > 0 ? 100 * length / total : 0));
  fmt::print("  features, by the slicer's comments: {}\n", fmt::join(words, ", "));
}

void print_lines(const rehearsal::Inspection& found) {
  for (const auto& word : found.unknown)
    fmt::print("  unknown word '{}': {} line{}, the first is {}{}\n", word.word, word.lines,
               word.lines == 1 ? "" : "s", word.first_line,
               word.word.starts_with('#') ? " (the controller's own language, ISG's and the like)" : "");
  for (const auto& line : found.passed_over)
    fmt::print("  line {} cannot be read, and is passed over: {}\n", line.line, line.why);
  for (const auto& line : found.refused.told)
    fmt::print("  line {} is refused, and left out here: {}{}\n", line.line, line.why,
               toolpath::can_be_ignored(line.command) ? "" : "; mend it before you rehearse");
  if (const auto more = found.refused.lines - static_cast<int>(found.refused.told.size()); more > 0)
    fmt::print("  {} more lines are refused\n", more);
}

void print_extent(const rehearsal::Inspection& found) {
  const toolpath::ProgramSummary& summary = found.summary;
  if (found.relative_extrusion)
    fmt::print("  {}; read here as relative: put M83 ahead of it, or rehearse with --relative-extrusion\n",
               rehearsal::relative_look(*found.relative_extrusion));
  const std::string told =
      found.told_filament ? fmt::format("; the slicer's comment says {:.1f} mm", to_mm(*found.told_filament))
                          : "";
  if (summary.printed)
    fmt::print("  prints {} moves from {} to {} mm, {:.1f} mm of filament{}\n", summary.prints,
               place(summary.printed->lower), place(summary.printed->upper), to_mm(summary.filament), told);
  else
    fmt::print("  prints nothing{}\n", told);
}

void print_material(const rehearsal::Inspection& found, const std::string& machines) {
  const std::string& chosen = found.request.material;
  if (found.told_material.empty() || machines.empty()) return;
  fmt::print("  material: {} for the slicer", found.told_material);
  if (found.told_material != machines && chosen.empty())
    fmt::print("; models/materials has none of that name, so that it is judged as {} (docs/materials.md)",
               machines);
  fmt::print("\n");
}

void print_process(const rehearsal::Inspection& found) {
  fmt::print("  nozzle: {:.2f} mm on the machine", to_mm(found.machine_nozzle));
  if (found.nozzle) fmt::print(", {:.2f} mm for the slicer", to_mm(*found.nozzle));
  fmt::print("; ");
  const auto& temperatures = found.summary.temperatures;
  if (const auto& chosen = found.request.dialect.temperature_c; !found.summary.heated_first)
    fmt::print("no temperature is set before the first bead{}\n",
               chosen ? fmt::format(", {:g} C is taken", *chosen) : "");
  else
    for (std::size_t i = 0; i < temperatures.size(); ++i)
      fmt::print("{}{:.0f}{}", i ? ", " : "", temperatures[i] - kCelsiusZero,
                 i + 1 == temperatures.size() ? " C\n" : "");
}

std::string minutes(double seconds) {
  const auto whole = std::llround(seconds);
  if (whole < 60) return fmt::format("{} s", whole);
  return whole >= 3600 ? fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60)
                       : fmt::format("{} min {} s", whole / 60, whole % 60);
}

void print_time(const rehearsal::PrintTime& time) {
  if (!time.planned && !time.slicers) return;
  std::string text;
  if (time.planned) text = minutes(*time.planned) + " on the machine";
  if (time.slicers)
    text += fmt::format("{}{} for the slicer", text.empty() ? "" : ", ", minutes(*time.slicers));
  if (time.planned && time.slicers && *time.slicers > 0)
    text += fmt::format(" ({:+.1f} %)", 100 * (*time.planned / *time.slicers - 1));
  fmt::print("  time: {}\n", text);
  if (time.limits.empty()) return;
  std::vector<std::string> limits;
  for (const rehearsal::OtherLimit& limit : time.limits)
    limits.push_back(fmt::format("{} {:g} {} (here {:g})", limit.name, limit.slicer, limit.unit, limit.here));
  fmt::print("  the slicer counts with other limits: {}\n", fmt::join(limits, ", "));
}

void print_foreign_words(const rehearsal::Inspection& found, const std::string& machine) {
  if (found.foreign_words.empty()) return;
  fmt::print("  {} turn axes that {} does not have: ", fmt::join(found.foreign_words, " "), machine);
  const auto& others = found.machines_with_words;
  if (others.empty())
    fmt::print(
        "map them under gcode.words of a machine's file (docs/machine-description.md); read here as if they "
        "turned nothing\n");
  else
    fmt::print("read here as for {}; with such words: {}\n", found.request.machine, fmt::join(others, ", "));
}

void print_readings(const rehearsal::Inspection& found) {
  if (found.readings.empty()) return;
  const std::string& letters = found.rotary_letters;
  fmt::print(
      "  readings of the rotary words, the most likely first:\n"
      "    X Y Z are             {:>3} {:>3}   longest printed step   path out of the layer (median)   "
      "thickest to thinnest bead   in the air\n",
      letters.substr(0, 1), letters.substr(1));
  for (std::size_t i = 0; i < found.readings.size() && i < kReadingsShown; ++i) {
    const rehearsal::RotaryReading& reading = found.readings[i];
    fmt::print("    {:<21} {:>3d} {:>3} {:>19.2f} mm {:>28.2f} deg {:>25.3g} {:>10.1f} %\n",
               reading.coordinates, reading.b_sign,
               letters.size() > 1 ? fmt::format("{}", reading.c_sign) : "",
               to_mm(reading.quality.longest_step), to_deg(reading.quality.out_of_layer),
               reading.quality.bead_spread, 100 * reading.floating);
  }
}

/// At a glance: the rehearsal looks at every pose.
void print_misfit(const rehearsal::Inspection& found) {
  if (!found.summary.printed) return;
  std::string why;
  try {
    why = rehearsal::misfit(found.request);
  } catch (const InputError&) {
    return;  // the rehearsal says so
  }
  if (why.empty()) return;
  fmt::print(
      "  does not fit there: {}; `understudy place {} --machine {}` looks for a place where it does, and "
      "`rehearse --place auto` puts it there\n",
      why, shell_quoted(found.request.program), shell_quoted(found.request.machine));
}

int inspect(const std::string& program, const std::string& machine, const rehearsal::DialectRequest& told) {
  const rehearsal::Inspection found = rehearsal::inspect(program, machine, told.macros, told);
  const auto maker = found.slicer_facts.find("generated by");
  fmt::print("{}: {} lines{}\n", program, found.lines,
             maker == found.slicer_facts.end() ? "" : ", by " + maker->second);
  if (found.robot) print_robot_program(found);
  print_foreign_words(found, machine);
  print_lines(found);
  if (const std::string& letter = found.request.dialect.extruder_letter; !letter.empty())
    fmt::print("  it has no E: {} feeds the filament, as it grows evenly along the path\n", letter);
  print_extent(found);
  if (const auto& printed = found.summary.printed;
      printed && printed->lower.z() > rehearsal::kFarAbove && found.request.dialect.place_mm[2] == 0)
    fmt::print(
        "  its lowest bead lies {:.2f} mm above z = 0: name what carries it by --fixture, or move it by "
        "--place\n",
        to_mm(printed->lower.z()));
  print_layers(found.summary);
  print_beads(found.summary);
  print_features(found.feature_lengths);
  print_process(found);
  print_material(found, found.machine_material);
  print_time(found.time);
  if (found.summary.tilt_max > 0.5 * kDegree)
    fmt::print("  the tool leans by up to {:.1f} deg\n", to_deg(found.summary.tilt_max));
  print_readings(found);
  print_misfit(found);
  fmt::print("to rehearse it: {}\n",
             rehearsal::rehearse_command(found.request, std::filesystem::path(program).stem().string()));
  return kGood;
}

}  // namespace

void add_inspect(CLI::App& app, Action& action) {
  auto program = std::make_shared<std::string>();
  auto machine = std::make_shared<std::string>(machine::kDefaultMachine);
  auto told = std::make_shared<rehearsal::DialectRequest>();
  auto* command = app.add_subcommand(
      "inspect", "What a program uses and prints, how its rotary words may be read, and how to rehearse it");
  command->add_option("program", *program, "G-code, KRL or RAPID")->required();
  add_machine_option(*command, *machine);
  command->add_option("--macros", told->macros, "Klipper's configuration: macros that the program calls");
  add_reading_options(*command, *told);
  add_process_options(*command, *told);
  command->callback([=, &action] { action = [=] { return inspect(*program, *machine, *told); }; });
}

}  // namespace understudy::cli
