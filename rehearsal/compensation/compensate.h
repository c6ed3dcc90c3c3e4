// A program that makes a controller with nominal kinematics put the tip where the original asks for it
// (docs/compensation.md).
#pragma once

#include <string>
#include <vector>

#include "control/compensation/compensated_lines.h"
#include "core/progress.h"
#include "machine/calibrated_parameters.h"
#include "machine/description.h"
#include "rehearsal/compensation/predicted_play.h"
#include "rehearsal/request/request.h"
#include "toolpath/program.h"

namespace understudy::rehearsal {

struct CompensationRequest {
  std::string program;     ///< path of G-code
  std::string machine;     ///< calibrated: name or path
  std::string nominal;     ///< the same before its calibration; empty: as the calibrated file draws it
  DialectRequest dialect;  ///< always strict: a line that cannot be read is refused
  double tolerance_um = 2;
  bool play = true;  ///< correct for the predicted sides
  PlayReference reference = PlayReference::middle;
};

struct Compensation {
  std::string text;           ///< the compensated program
  toolpath::Program program;  ///< as a nominal controller reads it
  int lines = 0;              ///< of the original, that go elsewhere
  int added_lines = 0;
  int kept_moves = 0;       ///< moves that homing or macros make, and that stay as they are
  double largest_move = 0;  ///< [m], between a commanded tip and the one asked for
  double predicted_before =
      0;  ///< [m] RMS of the tip while printing: the nominal controller and the original
  double predicted_geometry = 0;  ///< with the geometry put right
  double predicted = 0;           ///< of `text`
  int rounds = 0;                 ///< of prediction that `text` took; 0: play is not corrected
};

/// What a controller holds that knows nothing of the calibration. Throws InputError where there is none.
machine::MachineDescription as_drawn(const machine::MachineDescription& calibrated);

/// Throws InputError as read_gcode() does, for machines that are not one machine before and after its
/// calibration, and with line, value and limit where the original or the compensated program breaks a limit
/// of either.
Compensation compensate(const CompensationRequest& request, const Progress& progress = {});

/// The same for descriptions and a text in memory.
struct CompensationInput {
  const machine::MachineDescription& nominal;
  const machine::MachineDescription& known;
  const machine::CalibratedParameters& parameters;
  std::string text, file;
};
Compensation compensate(const CompensationInput& input, const CompensationRequest& request,
                        const Progress& progress = {});

}  // namespace understudy::rehearsal
