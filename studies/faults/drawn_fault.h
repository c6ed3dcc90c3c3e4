// A fault drawn at random, in the words that `understudy rehearse --fault` takes: what runs in the study is
// what a user repeats.
#pragma once

#include <string>
#include <vector>

#include "control/gap/gap_stop.h"
#include "core/random.h"
#include "machine/description.h"

namespace understudy::studies {

struct DrawnFaultKind {
  std::string word;        ///< of `fault`; "none": nothing goes wrong
  bool of_camera = false;  ///< of the gap sensor's pictures
  bool of_machine = false;
  std::vector<control::GapStop> named_by;  ///< stops whose reason names what there is to see of it
};

/// Nothing first, then every fault of the machine, then every fault of the gap sensor.
const std::vector<DrawnFaultKind>& drawn_fault_kinds();

/// True where the machine has such a fault at all: a sensor, an axis with play, a motor that may be
/// without current without its axis falling, where the quasistatic engine has no answer.
bool can_have(const machine::MachineDescription& machine, const DrawnFaultKind& kind);

/// Strikes at a time from 0 to `end` [s]. Axis, size and share of the frames are drawn over all that is
/// allowed; sizes evenly by their order of magnitude, from what nobody notices to what ruins any print. Empty
/// for nothing.
std::string draw_fault_words(const DrawnFaultKind& kind, double end,
                             const machine::MachineDescription& machine, Random& random);

}  // namespace understudy::studies
