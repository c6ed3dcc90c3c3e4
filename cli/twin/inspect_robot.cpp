#include "cli/twin/inspect_robot.h"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/text/printable.h"
#include "core/units.h"

namespace understudy::cli {
namespace {

constexpr std::size_t kShown = 8;

/// "LIN 120, WAIT 3", the most frequent first.
std::string counted(const std::map<std::string, int>& counts) {
  std::vector<std::pair<std::string, int>> all(counts.begin(), counts.end());
  std::ranges::stable_sort(all, [](const auto& a, const auto& b) { return a.second > b.second; });
  std::string text;
  for (std::size_t i = 0; i < all.size() && i < kShown; ++i)
    text += fmt::format("{}{} {}", i ? ", " : "", all[i].first.empty() ? "none" : printable(all[i].first, 60),
                        all[i].second);
  if (all.size() > kShown) text += fmt::format(" and {} more", all.size() - kShown);
  return text.empty() ? "none" : text;
}

void print_signal(const toolpath::RobotFacts& facts, const rehearsal::RobotProgramRequest& request) {
  for (const toolpath::RobotOutput& output : facts.outputs)
    fmt::print("  output {}: {}, set {} time{}, {:g} to {:g}\n", printable(output.name, 60),
               output.analogue ? "analogue" : "switched", output.set, output.set == 1 ? "" : "s", output.low,
               output.high);
  if (facts.signal.empty()) {
    fmt::print("  no output is set: `--signal always` prints every straight move, with --bead or --flow\n");
    return;
  }
  fmt::print(
      "  filament is fed by {}; a bead of {:g} x {:g} mm is assumed: say by --bead WIDTHxHEIGHT what it is, "
      "or by "
      "--flow how many mm3/s a signal of 1 feeds\n",
      printable(fmt::format("{}", fmt::join(facts.signal, " with ")), 120), request.bead_mm[0],
      request.bead_mm[1]);
  if (facts.rest_with_signal > 0)
    fmt::print("  it waits {:.1f} s with the signal on, during which --bead feeds nothing and --flow does\n",
               facts.rest_with_signal);
}

}  // namespace

void print_robot_program(const rehearsal::Inspection& found) {
  const toolpath::RobotFacts& facts = *found.robot;
  fmt::print("  {}, told by {}: {}\n", to_string(facts.language), found.told_by, counted(facts.statements));
  fmt::print("  moves by base: {}; by tool: {}\n", counted(facts.bases), counted(facts.tools));
  if (facts.fastest > 0)
    fmt::print("  speeds {:g} to {:g} mm/s\n", to_mm(facts.slowest), to_mm(facts.fastest));
  if (!facts.tool_points.empty())
    fmt::print("  {} of its tool points out of the nozzle\n", facts.tool_points);
  if (facts.axis_moves > 0)
    fmt::print("  {} move{} by axis values, the first in line {}: read as motion to the machine's home\n",
               facts.axis_moves, facts.axis_moves == 1 ? "" : "s", facts.first_axis_move);
  print_signal(facts, found.request.dialect.robot);
}

}  // namespace understudy::cli
