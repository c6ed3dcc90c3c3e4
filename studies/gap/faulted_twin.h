// Approaches and prints under faults on the whole twin: built machines that a lab has calibrated, a clamped
// part, a plant with play, rendered pictures, the print loop of the real machine. Every trial has one fault
// of the picture or of the machine; what is asked is whether the nozzle touches, and whether the answer names
// what went wrong (docs/gap-control.md).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/progress.h"
#include "machine/default_machine.h"
#include "studies/gap/faulted_trial.h"

namespace understudy::studies {

struct FaultedTwinRequest {
  std::string machine = machine::kDefaultMachine;  ///< as drawn
  std::string program;                             ///< of the bottle's line
  FaultedTask task = FaultedTask::approach;
  std::vector<std::string> faults;  ///< names of fault_types(); empty: all
  int trials = 100;                 ///< the faults take turns
  int worlds = 20;                  ///< built machines, each on the bottle and on a plate
  std::uint64_t seed = 1;
  std::vector<PlantChoice> plants{PlantChoice{}};  ///< every trial on each
  int threads = 1;                                 ///< the result does not depend on it
};

/// A world on a surface that is not used: without any fault it does not end well.
struct UnsoundWorld {
  std::uint64_t world = 0;
  std::string surface, why;
};

/// How the answers of another plant differ from those of the first.
struct PlantDifference {
  int other_answers = 0;                            ///< trials
  double gap_median = 0, gap_p95 = 0, gap_max = 0;  ///< [m], of the least gap, where the answers are equal
};

struct PlantTrials {
  PlantChoice plant;
  std::vector<FaultedTrial> trials;
  PlantDifference difference;  ///< of the first: nothing

  int count(Judgement judgement) const;
  /// Neither touches nor answers that are wrong.
  bool good() const;
};

struct FaultedTwin {
  FaultedTask task = FaultedTask::approach;
  int worlds = 0;
  std::vector<UnsoundWorld> unsound;
  std::vector<PlantTrials> plants;
};

/// Counts by fault and answer: the confusion table, in the order of fault_types().
struct ConfusionCell {
  std::string fault, answer;
  int right = 0, not_in_play = 0, wrong = 0;  ///< wrong: the other three judgements
};
std::vector<ConfusionCell> confusion(const std::vector<FaultedTrial>& trials);

/// Throws InputError for what is out of range, MachineError, Interrupted.
FaultedTwin run_faulted_twin(const FaultedTwinRequest& request, const Progress& progress = {});

}  // namespace understudy::studies
