#include "rehearsal/findings/advice.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include <fmt/format.h>

#include "core/text/shell_quoted.h"
#include "rehearsal/findings/flow_findings.h"

namespace understudy::rehearsal {
namespace {

/// The option that puts the program so much higher than in this run.
std::string place_higher(double height_mm, const Record& record) {
  const auto& [x, y, z] = record.place_mm;
  constexpr double kSteps = 100;  // hundredths of a millimetre, rounded up
  return fmt::format("`--place {:g},{:g},{:g}`", x, y, std::ceil(kSteps * (z + height_mm)) / kSteps);
}

std::string show_reach(const Record& record) {
  return fmt::format("`understudy workspace --machine {}` shows what it reaches",
                     shell_quoted(record.machine_word));
}

std::string calibrate(const Record& record) {
  return fmt::format(
      "calibrate: measure the tool's pose at the poses that `understudy sample-poses --machine {0} -o "
      "measured.csv` lists, then `understudy calibrate measured.csv --machine {0} -o calibrated.yaml` and "
      "rehearse with `--machine calibrated.yaml`",
      shell_quoted(record.machine_word));
}

std::string move_into_reach(const Finding&, const Record& record) {
  return "shift the program into reach with `--place X,Y,Z` (mm) or `--place auto`, or change these lines; " +
         show_reach(record);
}

std::string print_less(const Finding&, const Record& record) {
  return fmt::format(
      "print it smaller or in parts, or on a larger machine; `understudy place {} --machine {} -o map.png` "
      "shows the margin over the table",
      shell_quoted(record.program_word), shell_quoted(record.machine_word));
}

std::string lean_less(const Finding&, const Record& record) {
  return fmt::format(
      "lean the tool less there, or shift the program with `--place X,Y,Z` (mm); `understudy workspace "
      "--machine {} --tilt 20` shows where it may lean by 20 degrees",
      shell_quoted(record.machine_word));
}

std::string avoid_singular_pose(const Finding&, const Record& record) {
  return "lead the tool past the singular pose: lean it by a degree more, or shift the program with `--place "
         "X,Y,Z` (mm); " +
         show_reach(record);
}

/// The nozzle is lower than planned: by `height_mm` at the worst.
std::string raise_nozzle(double height_mm, const Record& record) {
  if (record.measures_gap && record.gap_control == "off")
    return "let the machine measure the gap: `--gap-control start`";
  if (record.measures_gap && record.gap_control == "start")
    return "let the machine follow the surface along the path: `--gap-control continuous`";
  return fmt::format("print higher: {}; or {}", place_higher(height_mm, record), calibrate(record));
}

std::string about_contact(const Finding& finding, const Record& record) {
  const bool with_bead = finding.about == "nozzle and bead";
  if (with_bead && tip_error_explains(record, -finding.value)) return calibrate(record);
  if (with_bead)
    return "lead the nozzle over what is printed: lift it on these lines (the slicer's Z hop, `G1 Z...`) or "
           "go "
           "around; `--place` would lift the print with it";
  if (finding.about.starts_with("nozzle"))
    return raise_nozzle(record.gap_accepted_min_mm - finding.value, record);
  return "give the two more room: lean the tool away, print what is tall last, or shift the program with "
         "`--place X,Y,Z` (mm)";
}

std::string about_gap(const Finding& finding, const Record& record) {
  if (finding.about == kStopped && record.fixture_name.empty())
    return "if the print lies on a part, name it: `--fixture FILE.stl`; else look at the laser frames in the "
           "report";
  if (finding.about == kStopped)
    return fmt::format(
        "look at the laser frames in the report; is the part where the program expects it (`--place X,Y,Z`)? "
        "If the dot "
        "moves beside its line, laser and camera are not where the machine file has them: take pictures of "
        "the dot over "
        "a flat and run `understudy calibrate gap-sensor table.csv --machine {} -o ready.yaml` "
        "(docs/gap-sensor-calibration.md)",
        shell_quoted(record.machine_word));
  if (finding.about == kUncontrolled)
    return "begin each bead with a straight move against the tool axis, as `understudy plan surface` does";
  if (finding.about == kUnmeasured)
    return "nothing, if these beads lie level with the one before; else begin them where the dot meets the "
           "part";
  return raise_nozzle(finding.limit - finding.value, record);
}

std::string about_adhesion(const Finding& finding, const Record& record) {
  if (finding.about == kTooLow) return raise_nozzle(record.gap_accepted_min_mm - finding.value, record);
  if (finding.about == kLifted && record.gap_control != "continuous")
    return record.measures_gap ? raise_nozzle(0, record) : calibrate(record);
  if (finding.about == kLifted)
    return "look at the curves of gap and tip error from this line on: play, heat, lost steps or an offset "
           "that was carried on lifts the nozzle; begin such beads where the dot meets what is printed";
  if (finding.about == kCold)
    return "print the layer sooner, hotter (`M104 S...`) or with less fan (`M106 S...`)";
  if (finding.about == kNothingBelow && record.fixture_name.empty())
    return "if the print lies on a part, name it: `--fixture FILE.stl`; else move it onto the table with "
           "`--place X,Y,Z` (mm)";
  if (finding.about == kNothingBelow) return "move the program over the part with `--place X,Y,Z` (mm)";
  if (record.measures_gap && record.gap_control != "continuous")
    return raise_nozzle(0, record);  // what measures the gap mends it either way
  return "print lower there: a first layer's height within the accepted gap, or `--place X,Y,Z` (mm)";
}

/// The twin holds an axis at the end of its range: where the tip is and what it touches follows from that.
bool axis_is_held(const Record& record) {
  static const std::set<std::string> kinds{"strut_length", "joint_limit", "unreachable"};
  return std::any_of(record.findings.begin(), record.findings.end(), [](const Finding& finding) {
    return finding.severity == Severity::error && kinds.contains(finding.kind);
  });
}

std::string about_accuracy(const Finding& finding, const Record& record) {
  if (axis_is_held(record))
    return "bring the axes within their ranges first: the tip is off where one is held at its end";
  constexpr double kTolerable = 2;  // times the limit: more is no question of tolerance
  if (finding.value > kTolerable * finding.limit) return calibrate(record);
  return fmt::format("{}; or accept it with `{} {:g}`", calibrate(record),
                     finding.about == kTip ? "--tip-tolerance" : "--orientation-tolerance",
                     std::ceil(10 * finding.value) / 10);
}

std::string about_registration(const Finding&, const Record& record) {
  return fmt::format(
      "see in the report which places did not fit: is it this part, clamped as drawn and clean, and are the "
      "machine "
      "(`understudy calibrate`) and its gap sensor (`understudy calibrate gap-sensor`) calibrated? Is what "
      "`part` "
      "of the section tolerances of {} says of the clamped part true?",
      shell_quoted(record.machine_word));
}

std::string about_flow(const Finding& finding, const Record&) {
  if (finding.about == kVoids)
    return fmt::format(
        "feed more: raise the slicer's extrusion multiplier (or `M221 S...`) by {:.0f} %, or set lines "
        "closer",
        100 * (1 / finding.value - 1));
  if (finding.about == kOverfilled)
    return fmt::format(
        "feed less: lower the slicer's extrusion multiplier (or `M221 S...`) by {:.0f} %, or set lines apart",
        100 * (1 - 1 / finding.value));
  if (finding.about == kLag)
    return "no more filament, for enough is fed: print slower, at half of the speed (`M220 S50`) and again "
           "half until nothing lags; or, where the firmware makes up for the lag (pressure advance), tell "
           "what "
           "is left of it: `--machine 'NAME{process.extruder_lag_ms: 5}'`";
  if (finding.about == kNozzleCold || finding.about == kNozzleHot)
    return fmt::format(
        "set {:.0f} C or {} (`M109 S...`), or name the material that is loaded: `--material NAME`",
        finding.limit, finding.about == kNozzleCold ? "more" : "less");
  return "lower the feed F where the bead begins and ends, or let the extruder start earlier";
}

std::string about_program(const Finding& finding, const Record&) {
  if (finding.about == kOtherNozzle)
    return fmt::format("if that nozzle will be mounted: `--nozzle {:g}`; else slice for the one of {:g} mm",
                       finding.value, finding.limit);
  if (finding.about == kOtherLayer)
    return "look whether `--place X,Y,Z` (mm) has the program at its height, and at the slicer's layers";
  if (finding.about == kOtherFilament)
    return fmt::format(
        "if that filament will be loaded: `--machine 'NAME{{tool.filament_diameter_mm: {:g}}}'`; else slice "
        "for "
        "the one of {:g} mm",
        finding.value, finding.limit);
  if (finding.about == kRelativeExtrusion)
    return fmt::format(
        "rehearse it with `--relative-extrusion`; on the machine put M83 ahead of line {}, where no macro of "
        "its "
        "firmware says so",
        finding.gcode_line);
  if (finding.about == kOtherAmount)
    return "look whether E is absolute or relative (`--relative-extrusion`, M82, M83), at `M221`, and at the "
           "printer's macros";
  if (finding.about == kOtherMaterial)
    return "name the material that will be loaded: `--material NAME`; docs/materials.md tells how to "
           "describe "
           "one";
  if (finding.about == kOtherFlow)
    return "look at the slicer's extrusion multiplier, at `M221`, and at the diameter of the filament";
  if (finding.about.starts_with(kPassedOver))
    return "mend this line and rehearse again: what the machine does there is not known, and everything else "
           "here is about the program without it";
  return "mend this line and rehearse again: the machine would jam or lay what no nozzle lays, and "
         "everything "
         "else here is about the program without that filament";
}

using About = std::function<std::string(const Finding&, const Record&)>;

About always(const char* text) {
  return [text](const Finding&, const Record&) { return text; };
}

const std::map<std::string, About>& advice_by_kind() {
  static const std::map<std::string, About> kinds{
      {"strut_length", move_into_reach},
      {"joint_limit", move_into_reach},
      {"joint_angle", lean_less},
      {"unreachable", move_into_reach},
      {"placement", print_less},
      {"singularity", avoid_singular_pose},
      {"axis_velocity", always("lower the feed F there; else the print takes longer than programmed")},
      {"axis_acceleration", always("lower the feed F there; else the print takes longer than programmed")},
      {"collision", about_contact},
      {"near_collision", always("nothing, if the machine's bodies are described as large as they are")},
      {"accuracy", about_accuracy},
      {"gap", about_gap},
      {"gouge",
       always("calibrate the machine, take the play out of its axes, or mill with `--depth-of-cut` and "
              "`--fit` as the part was planned")},
      {"left_over",
       always("is it the part that the program was planned for (`--intended`), and the stock "
              "(`--depth-of-cut`, `--stock`)? Else calibrate the machine, or choose a finer `--pitch`")},
      {"registration", about_registration},
      {"flow", about_flow},
      {"program", about_program},
      {"adhesion", about_adhesion},
      {"assumption", always("measure them, write them into the machine's file, and take their words out of "
                            "`assumed` there (docs/arms.md)")},
      {"unchecked", always("put the meshes beside the machine's file and take the links out of "
                           "`geometry.unchecked_links` (docs/arms.md)")},
      {"sag", always("draw the strand slower and with more fan (`M106 S255`), or hold it at both ends")}};
  return kinds;
}

}  // namespace

bool tip_error_explains(const Record& record, double depth_mm) {
  return record.accuracy && record.accuracy->tip_max_um >= 1e3 * depth_mm;
}

std::string advice(const Finding& finding, const Record& record) {
  if (finding.kind == "unreachable" && finding.about == kStopped)
    return "mend what stopped it; everything after this line is not simulated";
  const auto entry = advice_by_kind().find(finding.kind);
  return entry == advice_by_kind().end() ? "" : entry->second(finding, record);
}

}  // namespace understudy::rehearsal
