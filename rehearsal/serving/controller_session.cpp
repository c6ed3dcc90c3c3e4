#include "rehearsal/serving/controller_session.h"

#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"

namespace understudy::rehearsal {

std::string ControllerSession::take_output() { return std::exchange(out_, {}); }

const std::vector<std::string>& session_dialects() {
  static const std::vector<std::string> words{"grbl", "marlin"};
  return words;
}

// grblHAL's default of $398, and Marlin's BLOCK_BUFFER_SIZE.
int planner_blocks(const std::string& dialect) { return dialect == "marlin" ? 16 : 100; }

std::unique_ptr<ControllerSession> make_session(const std::string& dialect, ServedMachine& machine) {
  if (dialect == "grbl") return make_grbl_session(machine);
  if (dialect == "marlin") return make_marlin_session(machine);
  throw InputError(
      fmt::format("unknown dialect '{}': one of {}", dialect, fmt::join(session_dialects(), ", ")));
}

}  // namespace understudy::rehearsal
