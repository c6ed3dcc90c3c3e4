// One approach or one print under one fault on the whole twin, and the judgement of its answer.
#pragma once

#include <cstdint>
#include <string>

#include "rehearsal/run_twin.h"
#include "studies/gap/injected_fault.h"

namespace understudy::studies {

/// An engine and its time step.
struct PlantChoice {
  std::string engine = "quasistatic";
  double timestep = 0;  ///< [s]; 0: the engine's own
};
/// "mujoco:0.1" is 0.1 ms. Throws InputError for words that are none, and steps outside 0.01 to 5 ms.
PlantChoice plant_choice(const std::string& words);
std::string to_string(const PlantChoice& plant);

enum class FaultedTask { approach, print };

enum class Judgement {
  right,        ///< the aim was reached, or the print ended, with the true gap in the band; or a right reason
  not_in_play,  ///< the fault came too late, or changed nothing to be seen; and nothing stopped
  wrong_reason,  ///< a stop for a reason that does not name it
  not_found,     ///< no stop, and the true gap is not in the band
  touched        ///< the nozzle
};
const char* to_string(Judgement judgement);

/// One trial on one plant.
struct FaultedTrial {
  int number = 0;
  std::uint64_t world = 0;  ///< seed of the built machine
  std::string surface, fault;
  std::string words;   ///< the fault as drawn
  std::string answer;  ///< "reached", "completed", or the reason of the stop
  std::string why;     ///< of the stop
  bool stopped = false;
  double least_gap = 0;  ///< [m], true, of all nozzle to all part, over all of the way, the retreat included
  double last_gap = 0;  ///< [m], true, where the approach ended, or over the last half millimetre of the bead
  double duration = 0;  ///< [s]
  Judgement judgement = Judgement::right;
};

/// A built machine with a part, and when a fault may strike.
struct FaultWorld {
  std::uint64_t seed = 0;
  std::string surface;
  rehearsal::TwinSetup setup;  ///< without a fault
  FaultWindow window;
  std::string unsound;  ///< why it does not end well without a fault; empty: it does
};

/// Runs it without a fault, which tells when one may strike.
void prove_sound(FaultedTask task, FaultWorld& world);

/// The fault is drawn from seed and number.
FaultedTrial run_faulted_trial(const FaultWorld& world, FaultedTask task, const FaultType& type,
                               const PlantChoice& plant, std::uint64_t seed, int number);

/// What became of a run under a fault; `trial` gets its answer, gaps and judgement.
void judge(const FaultType& type, const InjectedFault& fault, FaultedTask task,
           const machine::GapLimits& limits, const rehearsal::TwinRun& run, FaultedTrial& trial);

}  // namespace understudy::studies
