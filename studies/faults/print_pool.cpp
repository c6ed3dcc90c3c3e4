#include "studies/faults/print_pool.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "control/motion/constraint_check.h"
#include "control/program/gcode_options.h"
#include "core/digest.h"
#include "core/error.h"
#include "core/file/output_file.h"
#include "core/interrupt.h"
#include "machine/file/calibration_section.h"
#include "machine/file/gap_sensor_section.h"
#include "machine/file/section_text.h"
#include "machine/fixture_file.h"
#include "studies/faults/drawn_print.h"
#include "studies/gap/lab_machine.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::studies {
namespace fs = std::filesystem;
namespace {

constexpr int kDraws = 200;           // of a print, until one is good
constexpr double kLongestPrint = 40;  // [s]
constexpr double kLabShare = 0.5;  // of the prints of a machine that sees, on one that a lab has calibrated
constexpr double kSampledShare = 0.7;  // of the others; the rest are as drawn

int count_approaches(const toolpath::Program& program) {
  int count = 0;
  for (std::size_t i = 1; i < program.steps.size(); ++i)
    count += program.steps[i].kind == toolpath::StepKind::print &&
             program.steps[i - 1].kind == toolpath::StepKind::move;
  return count;
}

/// Nothing where the planner refuses what was drawn.
std::optional<DrawnPrint> try_to_plan(const machine::MachineDescription& machine, Random& random) {
  try {
    return draw_print(machine, random);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

struct GoodDraw {
  DrawnPrint drawn;
  double duration = 0;  // [s], planned
};

/// Nothing where the machine as drawn cannot print it.
std::optional<GoodDraw> within_limits(const machine::MachineDescription& machine,
                                      std::optional<DrawnPrint> drawn) {
  if (!drawn) return std::nullopt;
  const auto report = control::check_constraints(drawn->program, machine);
  if (!report.findings.empty() || report.duration > kLongestPrint) return std::nullopt;
  return GoodDraw{std::move(*drawn), report.duration};
}

/// Every pose has a solution, whatever its limits: quickly asked.
bool has_poses_of(const machine::MachineDescription& machine, const toolpath::Program& program) {
  const auto mechanism = machine.make_mechanism();
  const Pose X_BW = machine.X_WB.inverse();
  std::vector<double> axes(static_cast<std::size_t>(mechanism->axis_count()));
  return std::all_of(program.steps.begin(), program.steps.end(), [&](const toolpath::Step& step) {
    return step.kind != toolpath::StepKind::print ||
           mechanism->inverse(X_BW * step.X_WT, {}, axes) == kinematics::SolveStatus::ok;
  });
}

/// True when the machine as drawn can print it.
bool draw_once(Random& random, const fs::path& folder, PoolPrint& print) {
  const std::optional<GoodDraw> good = within_limits(print.machine, try_to_plan(print.machine, random));
  if (!good) return false;
  const DrawnPrint& drawn = good->drawn;
  print.what = drawn.what;
  print.fixture = drawn.fixture;
  print.duration = good->duration;
  print.approaches = count_approaches(drawn.program);
  write_file(folder / print.program,
             toolpath::write_gcode(
                 drawn.program, {fmt::format("{}, drawn at random", drawn.what)},
                 {print.machine.dialect.extruder_letter, print.machine.dialect.commands_for_tips()}));
  const auto part =
      print.fixture.empty() ? nullptr : geometry::read_stl(machine::find_fixture(print.fixture));
  const toolpath::GcodeOptions gcode = control::gcode_options({}, print.machine);
  print.intended.emplace(toolpath::read_gcode(folder / print.program, gcode), part.get(),
                         tolerances_of(print.machine.file.string()));
  return true;
}

void choose_world(std::uint64_t seed, std::size_t number, const fs::path& folder, Random& random,
                  PoolPrint& print) {
  const double share = random.uniform();
  if (!print.machine.has_microscope || !print.machine.tolerances.mounting || share >= kLabShare) {
    print.as_built = random.uniform() < kSampledShare ? "sampled" : "nominal";
    return;
  }
  print.world = hash_bits(seed, number) % 1'000'000;
  print.as_built = "manufactured";
  print.own_machine = true;
  print.machine_word = fmt::format("machines/machine-{:03}.yaml", number);
  LabMachine lab = make_lab_machine(print.machine, *print.world);
  const std::string session = fmt::format("drawn poses and gaps of seed {}", *print.world);
  lab.machine.calibration->measurements = lab.machine.gap_sensor->measurements = session;
  lab.machine.calibration->measurements_sha256 = lab.machine.gap_sensor->measurements_sha256 =
      sha256_hex(session);
  const fs::path file = folder / print.machine_word;
  machine::write_calibrated(lab.machine, file, lab.calibrated);
  machine::write_with_section(file, machine::gap_sensor_section(lab.machine), file);
}

}  // namespace

bool can_print_any(const std::string& machine_word, std::uint64_t seed) {
  const auto machine = machine::load_machine(machine_word);
  Random random(seed, "whether it can print: " + machine.name);
  for (int draw = 0; draw < kDraws; ++draw) {
    stop_if_interrupted();
    std::optional<DrawnPrint> drawn = try_to_plan(machine, random);
    if (drawn && has_poses_of(machine, drawn->program) && within_limits(machine, std::move(drawn)))
      return true;
  }
  return false;
}

PoolPrint make_pool_print(const std::string& machine_word, std::uint64_t seed, std::size_t number,
                          const fs::path& folder) {
  PoolPrint print;
  print.machine = machine::load_machine(machine_word);
  print.machine_word = machine_word;
  print.program = fmt::format("programs/print-{:03}.gcode", number);
  Random random(seed, fmt::format("print {} of {}", number, print.machine.name));
  for (int draw = 0; draw < kDraws; ++draw) {
    stop_if_interrupted();
    if (!draw_once(random, folder, print)) continue;
    choose_world(seed, number, folder, random, print);
    return print;
  }
  throw InputError(
      fmt::format("machine {}: none of {} drawn prints is within its limits", machine_word, kDraws));
}

}  // namespace understudy::studies
