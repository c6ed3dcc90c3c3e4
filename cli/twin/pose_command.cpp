#include <cmath>
#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "cli/command.h"
#include "cli/options/machine_option.h"
#include "core/error.h"
#include "core/file/output_file.h"
#include "core/file/staged_file.h"
#include "core/units.h"
#include "machine/default_machine.h"
#include "machine/fixture_file.h"
#include "rehearsal/fixture.h"
#include "rehearsal/inspection/pose_look.h"
#include "rehearsal/scene.h"
#include "report/picture/png.h"
#include "report/picture/scene_pictures.h"
#include "report/pose_json.h"
#include "sim/as_built/as_built.h"

namespace understudy::cli {
namespace {

using kinematics::AxisVector;
using kinematics::Mechanism;

constexpr std::size_t kOthersShown = 7;

struct PoseCall {
  std::string machine = machine::kDefaultMachine;
  std::vector<std::string> words;  ///< of a line of a program
  std::vector<double> axes;        ///< mm or degrees
  std::string fixture, output, json;
};

double file_unit(const Mechanism& mechanism, std::size_t axis) {
  return mechanism.axis_is_angle(static_cast<int>(axis)) ? kDegree : kMillimetre;
}
const char* unit_name(const Mechanism& mechanism, std::size_t axis) {
  return mechanism.axis_is_angle(static_cast<int>(axis)) ? "deg" : "mm";
}

AxisVector axes_of(const PoseCall& call, const Mechanism& mechanism) {
  const auto count = static_cast<std::size_t>(mechanism.axis_count());
  if (call.axes.size() != count)
    throw InputError(fmt::format("--axes has {} values, the machine {} axes", call.axes.size(), count));
  AxisVector axes{};
  for (std::size_t i = 0; i < count; ++i) {
    if (!std::isfinite(call.axes[i]) || std::abs(call.axes[i]) > 1e6)
      throw InputError(fmt::format("--axes holds {:g}", call.axes[i]));
    axes[i] = call.axes[i] * file_unit(mechanism, i);
  }
  return axes;
}

void print_axes(const Mechanism& mechanism, const AxisVector& axes) {
  fmt::print("  {:<10} {:>14}  {:>28}  {:>18}\n", "axis", "position", "range", "to its nearest end");
  for (std::size_t i = 0; i < static_cast<std::size_t>(mechanism.axis_count()); ++i) {
    const double unit = file_unit(mechanism, i), q = axes[i];
    const char* name = unit_name(mechanism, i);
    const auto range = mechanism.axis_range(static_cast<int>(i));
    const bool ends = std::isfinite(range.lower) && std::isfinite(range.upper);
    fmt::print(
        "  {:<10} {:>10.3f} {:<3}  {:>28}  {:>18}\n", mechanism.axis_name(static_cast<int>(i)), q / unit,
        name,
        ends ? fmt::format("{:.1f} .. {:.1f} {}", range.lower / unit, range.upper / unit, name) : "endless",
        ends ? fmt::format("{:.3f} {}", std::min(q - range.lower, range.upper - q) / unit, name) : "-");
  }
}

void print_branches(const Mechanism& mechanism, const std::vector<AxisVector>& others) {
  fmt::print("  other ways to stand there within the ranges: {}\n", others.empty() ? "none found" : "");
  for (std::size_t k = 0; k < others.size() && k < kOthersShown; ++k) {
    std::string line;
    for (std::size_t i = 0; i < static_cast<std::size_t>(mechanism.axis_count()); ++i)
      line += fmt::format(" {} {:.3f}", mechanism.axis_name(static_cast<int>(i)),
                          others[k][i] / file_unit(mechanism, i));
    fmt::print("   {}\n", line);
  }
  if (others.size() > kOthersShown) fmt::print("    ... and {} more\n", others.size() - kOthersShown);
}

void print_clearance(const char* what, const std::optional<rehearsal::NearestPair>& pair) {
  if (!pair) return;
  fmt::print("  {}: {} ({} and {})\n", what,
             pair->distance > 0 ? fmt::format("{:.3f} mm", to_mm(pair->distance))
                                : fmt::format("{:.3f} mm deep", -to_mm(pair->distance)),
             pair->body, pair->obstacle);
}

void print_look(const rehearsal::PoseLook& look, const std::string& name, const Mechanism& mechanism) {
  const Vec3 p = 1e3 * look.X_WT.translation(), z = tool_axis(look.X_WT);
  fmt::print(
      "{}: tip ({:.3f}, {:.3f}, {:.3f}) mm, tool axis ({:.6f}, {:.6f}, {:.6f}), {:.2f} deg from upright: "
      "{}\n",
      name, p.x(), p.y(), p.z(), z.x(), z.y(), z.z(), to_deg(std::atan2(std::hypot(z.x(), z.y()), z.z())),
      look.good() ? "good" : "no good");
  for (const auto& violation : look.broken) fmt::print("  {}\n", to_string(violation));
  if (look.status != kinematics::SolveStatus::ok)
    return fmt::print("  the pose is {}\n", to_string(look.status));
  print_axes(mechanism, look.axes);
  fmt::print("  condition number {:.3g}: {}\n", look.condition,
             look.condition >= kinematics::kSingularCondition
                 ? "singular, or the machine cannot tilt its tool"
                 : fmt::format("the worst direction keeps {:.3g} of the best", 1 / look.condition));
  print_branches(mechanism, look.others);
  print_clearance("nozzle to what it prints on", look.nozzle);
  print_clearance("all else", look.nearest);
}

std::string picture_of(const machine::MachineDescription& machine, const rehearsal::PoseLook& look,
                       std::shared_ptr<const geometry::Mesh> part) {
  if (look.status != kinematics::SolveStatus::ok)
    throw InputError(fmt::format("no picture: the pose is {}", to_string(look.status)));
  rehearsal::Scene scene =
      rehearsal::machine_scene(machine, sim::as_described(machine), {look.X_WT, look.axes});
  scene.part = std::move(part);
  return report::encode_png(report::draw_overview(scene));
}

void check_outputs(const PoseCall& call) {
  if (!call.output.empty() && std::filesystem::path(call.output).extension() != ".png")
    throw InputError(fmt::format("{}: a picture ends in .png", call.output));
  for (const std::string& file : {call.output, call.json})
    if (!file.empty()) check_writable(file);
}

int run_pose(const PoseCall& call) {
  check_outputs(call);
  const auto machine = machine::load_machine(call.machine);
  const auto mechanism = machine.make_mechanism();
  std::shared_ptr<const geometry::Mesh> part;
  if (!call.fixture.empty()) part = rehearsal::read_fixture(machine::find_fixture(call.fixture), machine);
  const rehearsal::PoseLook look =
      call.axes.empty()
          ? rehearsal::look_at_words(machine, fmt::format("{}", fmt::join(call.words, " ")), part)
          : rehearsal::look_at_axes(machine, axes_of(call, *mechanism), part);
  std::vector<std::unique_ptr<StagedFile>> files;
  if (!call.output.empty())
    files.push_back(std::make_unique<StagedFile>(call.output, picture_of(machine, look, part)));
  if (!call.json.empty())
    files.push_back(std::make_unique<StagedFile>(
        call.json, report::pose_json(look, *mechanism, call.machine, command_line())));
  for (const auto& file : files) file->commit();
  print_look(look, machine.name, *mechanism);
  for (const std::string& file : {call.output, call.json})
    if (!file.empty()) fmt::print("{}\n", file);
  return look.good() ? kGood : kNo;
}

}  // namespace

void add_pose(CLI::App& app, Action& action) {
  auto call = std::make_shared<PoseCall>();
  auto* command = app.add_subcommand(
      "pose",
      "One pose looked at: axes, limits, other branches, distance from singular, clearance, a picture");
  auto* words =
      command->add_option("words", call->words,
                          "as on a line of a program: X10 Z5 B20, or X10 I0 J0.1736 K0.9848; without "
                          "any, home");
  add_machine_option(*command, call->machine);
  command->add_option("--axes", call->axes, "positions of all axes instead, in mm and degrees: 10,0,50,20,90")
      ->delimiter(',')
      ->excludes(words);
  command->add_option("--fixture", call->fixture,
                      "the inserted part: an STL in mm, or a name under models/parts");
  command->add_option("-o,--output", call->output, "IMAGE.png of the machine in this pose");
  command->add_option("--json", call->json, "FILE.json of the answer");
  command->footer("Exit status 1: a limit is broken, bodies touch, or the pose cannot be reached.");
  command->callback([=, &action] { action = [=] { return run_pose(*call); }; });
}

}  // namespace understudy::cli
