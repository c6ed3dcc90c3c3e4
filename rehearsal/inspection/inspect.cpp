#include "rehearsal/inspection/inspect.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <memory>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "control/program/rotary_words.h"
#include "core/error.h"
#include "core/file/read_file.h"
#include "core/text/shell_quoted.h"
#include "core/units.h"
#include "machine/description.h"
#include "machine/material.h"
#include "rehearsal/inspection/extruder_letter.h"
#include "rehearsal/inspection/inspect_robot.h"
#include "rehearsal/inspection/place_on_table.h"
#include "rehearsal/inspection/start_temperature.h"
#include "rehearsal/inspection/turning_letters.h"
#include "rehearsal/program/told_process.h"
#include "toolpath/inspection/feature_types.h"
#include "toolpath/inspection/slicer_filament.h"

namespace understudy::rehearsal {
namespace {

constexpr double kDefaultLayer = 0.2e-3;  // [m], where a program does not tell
constexpr double kSameNozzle = 0.05;      // of the bore

bool all_among(const std::string& letters, const std::string& known) {
  return std::ranges::all_of(letters, [&](char c) { return known.find(c) != std::string::npos; });
}

/// G and M words, and a firmware's commands in words; a parameter cannot be passed over.
bool is_command(const std::string& word) {
  const auto is_letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
  return word.size() > 1 && (word[0] == 'G' || word[0] == 'M' || is_letter(word[1]));
}

void add_once(std::vector<std::string>& words, const std::string& word) {
  if (std::ranges::find(words, word) == words.end()) words.push_back(word);
}

class Inspector {
 public:
  Inspector(const std::string& program, std::string text, const std::string& machine,
            const std::string& macros, const DialectRequest& told)
      : file_(program), text_(std::move(text)), machine_(machine::load_machine(machine)) {
    result_.request.program = program;
    result_.request.machine = machine;
    result_.lines = static_cast<int>(std::count(text_.begin(), text_.end(), '\n'));
    result_.request.dialect.nozzle_mm = told.nozzle_mm;
    result_.request.dialect.layer_mm = told.layer_mm;
    result_.request.dialect.temperature_c = told.temperature_c;
    result_.request.dialect.relative_extrusion = options_.relative_extrusion = told.relative_extrusion;
    result_.request.dialect.ignored = options_.ignored = told.ignored;
    take(machine_);
    options_.unknown = &result_.unknown;
    options_.passed_over = &result_.passed_over;
    options_.refused = &result_.refused;
    if (macros.empty()) return;
    result_.request.dialect.macros = macros;
    options_.macros = std::make_shared<toolpath::GcodeMacros>(toolpath::GcodeMacros::read(macros));
  }

  Inspection run() {
    result_.slicer_facts = toolpath::slicer_facts(text_);
    result_.told_filament = toolpath::told_filament(text_);
    result_.told_material = told_material(result_.slicer_facts);
    if (const auto nozzle = fact_number(result_.slicer_facts, "nozzle_diameter"))
      result_.nozzle = from_mm(*nozzle);
    find_extruder_letter();
    const std::string turning = turning_letters(text_, options_.extruder_letter);
    if (!all_among(turning, options_.rotary ? options_.rotary->letters : "")) read_for_others(turning);
    find_relative_extrusion();
    const bool known = result_.foreign_words.empty() || !result_.machines_with_words.empty();
    if (options_.rotary && !turning.empty() && known)
      rank();
    else
      summarise_as(options_);
    request_words();
    if (!machine_.process.material.empty()) request_material();
    request_temperature();
    request_place();
    if (result_.summary.printed) result_.time = print_time(result_.request, result_.slicer_facts);
    return std::move(result_);
  }

 private:
  void find_extruder_letter() {
    const std::set<char> letters = letters_of(text_);
    if (letters.contains(options_.extruder_letter) || !(letters.contains('A') || letters.contains('B')))
      return;
    const auto found = extruder_letter_of(text_, file_, options_, filament_diameter());
    if (!found) return;
    options_.extruder_letter = *found;
    result_.request.dialect.extruder_letter = *found;
  }

  /// M83 may stand in a macro that is not known here.
  void find_relative_extrusion() {
    toolpath::ExtrusionTally tally;
    toolpath::GcodeOptions look = options_;
    look.extrusion = &tally;
    toolpath::parse_gcode(text_, file_, look);
    if (!tally.looks_relative()) return;
    result_.relative_extrusion = tally;
    result_.request.dialect.relative_extrusion = options_.relative_extrusion = true;
  }

  Vec3 start_W() const { return options_.X_WT_home.translation(); }

  /// A ready machine that has these words takes the place of the one that does not.
  void read_for_others(const std::string& turning) {
    result_.foreign_words = turning;
    std::optional<std::pair<double, std::string>> best;
    for (const std::string& name : machine::machine_names()) {
      const machine::MachineDescription other = machine::load_machine(name);
      const auto words = control::rotary_words(other);
      if (!words || words->letters.size() != turning.size() || !all_among(turning, words->letters)) continue;
      result_.machines_with_words.push_back(name);
      take(other);
      const double angle = rank_readings({file_, text_}, options_).front().quality.out_of_layer;
      if (!best || angle < best->first) best = {angle, name};
    }
    if (best) {
      result_.request.machine = best->second;
      return take(machine::load_machine(best->second));
    }
    toolpath::RotaryWords still;  // whatever they turn
    still.letters = turning.substr(0, 2);
    text_ = without_words(text_, turning.substr(still.letters.size()));
    still.tip_pose = [](const Vec3& p_WT, double, double) -> Pose {
      return make_pose(Quat::Identity(), p_WT);
    };
    options_.rotary = still;
  }

  void take(const machine::MachineDescription& machine) {
    machine_ = machine;
    result_.machine_nozzle = machine_.tool.nozzle_diameter;
    result_.machine_material = machine_.process.material;
    options_.X_WT_home = machine_.X_WB * machine_.X_BT_home;
    options_.rotary = control::rotary_words(machine_);
    options_.extruder_letter = machine_.dialect.extruder_letter;
  }

  void rank() {
    result_.readings = rank_readings({file_, text_}, options_);
    result_.rotary_letters = options_.rotary->letters;
    const RotaryReading& best = result_.readings.front();
    coordinates_ = best.coordinates;
    if (coordinates_ != machine_.dialect.coordinates) result_.request.dialect.coordinates = coordinates_;
    result_.request.dialect.b_sign = best.b_sign;
    result_.request.dialect.c_sign = best.c_sign;
    summarise_as(read_as(best, options_));
  }

  void summarise_as(const toolpath::GcodeOptions& options) {
    const toolpath::Program program = toolpath::parse_gcode(text_, file_, options);
    result_.summary =
        toolpath::summarise(program, start_W(), filament_diameter(), toolpath::LayerComments(text_));
    result_.feature_lengths = toolpath::feature_lengths(program, toolpath::FeatureTypes(text_), start_W());
  }

  double filament_diameter() const {
    const auto said = fact_number(result_.slicer_facts, "filament_diameter");
    return said && *said > 0 ? from_mm(*said) : machine_.tool.filament_diameter;
  }

  void request_words() {
    for (const auto& word : result_.unknown)
      if (is_command(word.word)) add_once(result_.request.dialect.ignored, word.word);
    for (const auto& line : result_.refused.told)
      if (toolpath::can_be_ignored(line.command)) add_once(result_.request.dialect.ignored, line.command);
    auto& dialect = result_.request.dialect;
    const double bore = to_mm(machine_.tool.nozzle_diameter);
    if (const auto nozzle = result_.nozzle; !dialect.nozzle_mm && nozzle && *nozzle > 0 && bore > 0 &&
                                            std::abs(to_mm(*nozzle) - bore) > kSameNozzle * bore)
      dialect.nozzle_mm = std::round(1e3 * to_mm(*nozzle)) / 1e3;
    const auto filament = other_filament(machine_.tool, result_.slicer_facts);
    if (filament && result_.request.machine.find('{') == std::string::npos)
      result_.request.machine += fmt::format("{{tool.filament_diameter_mm: {:g}}}", *filament);
  }

  void request_material() {
    const std::string& told = result_.told_material;
    const std::vector<std::string> names = machine::material_names();
    if (told != machine_.process.material && std::ranges::find(names, told) != names.end())
      result_.request.material = told;
  }

  /// Where the program extrudes before it has heated the nozzle: a macro does that.
  void request_temperature() {
    auto& chosen = result_.request.dialect.temperature_c;
    if (chosen || result_.summary.heated_first) return;
    chosen = start_temperature(text_, result_.slicer_facts);
    const std::string& name =
        result_.request.material.empty() ? machine_.process.material : result_.request.material;
    if (!chosen && result_.summary.printed && !name.empty())
      chosen = std::round(machine::load_material(name).nozzle_temperature - kCelsiusZero);
  }

  /// Onto the table, and to its middle where it does not lie on it.
  void request_place() {
    const auto& printed = result_.summary.printed;
    if (!printed || coordinates_ == "machine") return;
    const auto& heights = result_.summary.layer_heights;
    // High above the table it may print on a part; a program of rotary words counts from its table's pivots.
    result_.request.dialect.place_mm =
        place_on_table(*printed, *result_.summary.part, machine_,
                       heights.empty() ? kDefaultLayer : heights.front(), !result_.readings.empty());
  }

  std::string file_, text_;
  machine::MachineDescription machine_;
  toolpath::GcodeOptions options_;
  std::string coordinates_;  // of the best reading
  Inspection result_;
};

}  // namespace

Inspection inspect(const std::string& program, const std::string& machine, const std::string& macros,
                   const DialectRequest& told) {
  std::string text = read_file(program);
  if (toolpath::robot_language(program, text)) return inspect_robot(program, text, machine);
  return Inspector(program, std::move(text), machine, macros, told).run();
}

std::string rehearse_command(const RehearsalRequest& request, const std::string& folder) {
  const DialectRequest& dialect = request.dialect;
  std::string command = fmt::format("understudy rehearse {} --machine {}", shell_quoted(request.program),
                                    shell_quoted(request.machine));
  if (dialect.place_auto)
    command += " --place auto";
  else if (dialect.place_mm != std::array<double, 3>{0, 0, 0})
    command += fmt::format(" --place {}", fmt::join(dialect.place_mm, ","));
  if (dialect.turn_deg != 0) command += fmt::format(" --turn {}", dialect.turn_deg);
  if (dialect.spin_deg != 0) command += fmt::format(" --spin {}", dialect.spin_deg);
  if (!request.home_axes.empty())
    command += fmt::format(" --home-axes {:.6g}", fmt::join(request.home_axes, ","));
  if (!request.fixture.empty()) command += " --fixture " + shell_quoted(request.fixture);
  if (!dialect.coordinates.empty()) command += " --coordinates " + dialect.coordinates;
  if (dialect.b_sign < 0) command += " --b-sign -1";
  if (dialect.c_sign < 0) command += " --c-sign -1";
  if (!dialect.extruder_letter.empty()) command += " --extruder-letter " + dialect.extruder_letter;
  if (!dialect.ignored.empty())
    command += " --ignore " + shell_quoted(fmt::format("{}", fmt::join(dialect.ignored, ",")));
  if (!dialect.macros.empty()) command += " --macros " + shell_quoted(dialect.macros);
  if (dialect.relative_extrusion) command += " --relative-extrusion";
  if (dialect.temperature_c) command += fmt::format(" --temperature {}", *dialect.temperature_c);
  if (dialect.nozzle_mm) command += fmt::format(" --nozzle {}", *dialect.nozzle_mm);
  if (dialect.layer_mm) command += fmt::format(" --layer {}", *dialect.layer_mm);
  if (!request.material.empty()) command += " --material " + shell_quoted(request.material);
  const RobotProgramRequest& robot = dialect.robot;
  if (!robot.signals.empty())
    command += " --signal " + shell_quoted(fmt::format("{}", fmt::join(robot.signals, ",")));
  if (robot.bead_mm[0] > 0) command += fmt::format(" --bead {:g}x{:g}", robot.bead_mm[0], robot.bead_mm[1]);
  if (robot.flow_mm3_per_s) command += fmt::format(" --flow {:g}", *robot.flow_mm3_per_s);
  if (!robot.tool_points.empty()) command += " --tool-points " + shell_quoted(robot.tool_points);
  return command + " --out " + shell_quoted(folder);
}

}  // namespace understudy::rehearsal
