// What a controller says in one line.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace understudy::drivers {

/// <Idle|MPos:...> of grbl.
struct ControllerStatus {
  std::string state;                ///< Idle, Run, Hold, Alarm...
  std::vector<double> machine;      ///< MPos, in the controller's order; empty: not told
  std::vector<double> work;         ///< WPos
  std::vector<double> work_offset;  ///< WCO
  std::optional<int> line;          ///< Ln, of the block that runs
  std::optional<int> planner_free;  ///< Bf, blocks
};

struct Reply {
  enum class Kind { other, ok, resend, error, alarm, banner, status, position, busy };
  Kind kind = Kind::other;
  int number = 0;                              ///< of a resend, an alarm, an error of grbl
  std::string text;                            ///< the line as it came
  ControllerStatus status;                     ///< of kind status
  std::vector<std::pair<char, double>> words;  ///< of kind position: X 12.5 ...
};

/// Anything that is not understood, as after garbage on the line, is `other`. The end of line is not part of
/// it.
Reply parse_reply(std::string_view line);

}  // namespace understudy::drivers
