#include "cli/twin/robot_options.h"

#include <array>
#include <charconv>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>

namespace understudy::cli {
namespace {

constexpr const char* kGroup = "Programs of robots (KRL, RAPID)";
constexpr double kLargestBead = 100;  // [mm]

/// 0.5x0.2, in mm. False: no bead is so wide and so high.
bool read_bead(const std::string& text, std::array<double, 2>& bead) {
  const auto number = [](std::string_view part, double& value) {
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    return error == std::errc() && end == part.data() + part.size() && value > 0 && value <= kLargestBead;
  };
  const std::size_t by = text.find('x');
  auto& [width, height] = bead;
  return by != std::string::npos && number(std::string_view(text).substr(0, by), width) &&
         number(std::string_view(text).substr(by + 1), height) && height <= width;
}

}  // namespace

void add_robot_options(CLI::App& command, rehearsal::RobotProgramRequest& robot) {
  command
      .add_option(
          "--signal", robot.signals,
          "output that feeds filament, such as OUT[1], ANOUT[2] or doExtrude; a switched and an analogue "
          "one with a comma; always: every straight move prints; without it the outputs that the program "
          "sets, where they are one or such a pair")
      ->delimiter(',')
      ->group(kGroup);
  command
      .add_option_function<std::string>(
          "--bead",
          [&robot](const std::string& text) {
            if (!read_bead(text, robot.bead_mm))
              throw CLI::ValidationError("--bead",
                                         "'" + text + "' is no WIDTHxHEIGHT in mm, such as 0.5x0.2");
          },
          "WIDTHxHEIGHT in mm: the bead that lies along the path while the signal is above 0")
      ->group(kGroup);
  command.add_option("--flow", robot.flow_mm3_per_s, "mm3/s that a signal of 1 feeds, switched or analogue")
      ->check(CLI::PositiveNumber)
      ->group(kGroup);
  command
      .add_option(
          "--tool-points", robot.tool_points,
          "axis of the program's tool that points out of its nozzle; without it the one that points down "
          "where it prints")
      ->check(CLI::IsMember({"x", "-x", "y", "-y", "z", "-z"}))
      ->group(kGroup);
}

}  // namespace understudy::cli
