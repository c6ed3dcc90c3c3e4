// To which sides the plays of a machine go along a program, as the quasistatic plant predicts it.
#pragma once

#include <vector>

#include "machine/calibrated_parameters.h"
#include "machine/description.h"
#include "sim/as_built/as_built.h"
#include "toolpath/gcode/rewrite/rewritten_path.h"
#include "toolpath/program.h"

namespace understudy::rehearsal {

/// What the numbers of a calibration count the plays from.
enum class PlayReference {
  middle,  ///< poses were measured, or computed, as if there were no play
  /// Poses were measured where the machine rests: the zeros of its axes have the sides that the plays lie on
  /// at home in them.
  rest,
};

/// The known machine with its play: what the calibration found where it did, else what the file states.
sim::AsBuilt known_machine(const machine::MachineDescription& known,
                           const machine::CalibratedParameters& parameters, PlayReference reference);

/// By how much the plays, and drives that yield, carry the tool off along a program.
class PlayAlongPath {
 public:
  /// Places of the original program, in their order. The shift is added to where the tool would be without
  /// play: of the tip [m], and a rotation vector [rad], both in W.
  void add(const toolpath::AskedPlace& place, const Twist& shift);
  /// Linear between the places; 0 before the first where there is none.
  Twist at(std::size_t step, double fraction) const;
  bool empty() const { return places_.empty(); }

 private:
  void keep(double place, const Twist& shift);
  std::vector<double> places_;  // step + fraction, ascending
  std::vector<Twist> shifts_;
  double last_place_ = -1;
  Twist last_shift_ = Twist::Zero();
};

struct PlayPrediction {
  PlayAlongPath play;
  double tip_rms = 0;           ///< [m], of the predicted tip from what was asked for, while filament is fed
  std::vector<double> squares;  ///< [m^2], summed over the cycles of each step of the original
};

/// Drives `program` by the nominal description, and the known machine by what its drives are told. Throws
/// InputError for a program that cannot be planned, MachineError where the plant fails; Interrupted.
PlayPrediction predict_play(const toolpath::Program& program, const toolpath::RewrittenPath& path,
                            const machine::MachineDescription& nominal,
                            const machine::MachineDescription& known, const sim::AsBuilt& built);

}  // namespace understudy::rehearsal
