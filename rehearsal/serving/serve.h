// One print, received over a line as a controller would receive it.
#pragma once

#include <functional>
#include <string>

#include "machine/description.h"
#include "rehearsal/serving/serve_line.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::rehearsal {

/// Where the machine is that a sender prints on.
struct ServedMotion {
  double time = 0;               ///< [s] of the machine, since the sender came
  Pose X_WT = Pose::Identity();  ///< as planned
  double filament = 0;           ///< [m], fed by now
  int moves = 0, refused = 0;    ///< that came by now, and lines
};

struct ServeOptions {
  std::string dialect = "grbl";                    ///< of session_dialects()
  double speed = 1;                                ///< seconds of the machine in one of `clock`
  std::function<double()> clock;                   ///< [s], that only advances
  std::function<bool()> stop;                      ///< the user has asked for the end
  std::function<void(const std::string&)> tell;    ///< what happens, for people; may be empty
  std::function<void(const ServedMotion&)> moved;  ///< while the tool moves; may be empty
};

/// What came.
struct ServedProgram {
  std::string text;  ///< accepted lines; refused ones as comments
  int moves = 0;
  int refused = 0;       ///< lines
  std::string ended;     ///< why: "the program has ended", "the sender has left"...
  bool aborted = false;  ///< it was reset or dropped while it moved
};

/// Serves senders, one at a time, until a program has come to its end (M2, M30), its sender has left or
/// aborted it, or `stop`. A sender that comes and goes without a move leaves nothing. Throws InputError for a
/// dialect that is none.
ServedProgram serve(ServeLine& line, const machine::MachineDescription& machine,
                    const toolpath::GcodeOptions& options, const ServeOptions& serving);

}  // namespace understudy::rehearsal
