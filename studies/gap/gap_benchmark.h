// How well the gap is measured, closed and followed: rendered pictures of surfaces under light that is good
// and bad, with the truth known (docs/gap-control.md).
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/progress.h"
#include "machine/default_machine.h"
#include "studies/gap/faulted_twin.h"

namespace understudy::studies {

struct GapBenchmarkRequest {
  std::string machine = machine::kDefaultMachine;
  std::vector<std::string> parts{"detectors", "approach", "following", "bottle"};
  /// Of approaches and of prints that are followed, a surface and condition; frames tenfold. Of faulted
  /// approaches, and of faulted prints, in all.
  int trials = 10;
  int machines = 20;  ///< as-built, of the bottle; built and calibrated, of faulted approaches and prints
  std::vector<PlantChoice> plants{PlantChoice{}};  ///< of faulted approaches and prints
  std::vector<std::string> faults;                 ///< of them; empty: all
  std::uint64_t seed = 1;
  int threads = 1;
  std::string program;  ///< of the bottle: scenarios/song-bottle.gcode unless given
  std::string command;  ///< for the record
};

/// Words of `parts`: the four that are run unless told otherwise, then faulted-approaches, faulted-prints.
const std::vector<std::string>& gap_benchmark_parts();

struct Spread {
  double median = 0, p95 = 0;
};

struct DetectorRow {
  std::string surface, condition, detector;
  int frames = 0, missed = 0;
  double bias_um = 0;   ///< mean of reading less truth
  double sigma_um = 0;  ///< scatter about that, a frame
  double p95_um = 0;    ///< of the distance from the truth
};

struct ApproachRow {
  std::string surface, condition;
  bool benign = false;  ///< the light is good: every stop is a false one
  int runs = 0, reached = 0, touches = 0, false_stops = 0;
  Spread error_um;  ///< of the gap from the aim, those that reached it
  Spread settle_s;
  std::map<std::string, int> stops;  ///< by reason
};

struct FollowingRow {
  std::string surface, condition;
  bool benign = false;
  int runs = 0, completed = 0, touches = 0, false_stops = 0;
  double in_band_fraction = 0;   ///< of the path that was printed
  Spread error_um;               ///< of the gap from the aim along it
  double followed_fraction = 0;  ///< frames used of those taken
  std::map<std::string, int> stops;
};

/// The gap at one place of the path, over all machines.
struct GapStation {
  double p05_mm = 0, median_mm = 0, p95_mm = 0;
};

/// One mode of gap control on the bottle, over all machines.
struct BottleRow {
  std::string mode;
  int machines = 0, printed = 0, touched = 0, kept = 0;  ///< kept: at least 99 % in the band
  double in_band_fraction = 0;                           ///< of the path, all machines together
  double in_band_worst = 0;                              ///< of a machine that printed
  double gap_p01_mm = 0, gap_median_mm = 0, gap_p99_mm = 0;
  std::map<std::string, int> stops;
  std::vector<GapStation> along;  ///< evenly, of those machines that printed to the end
};

struct GapBenchmark {
  GapBenchmarkRequest request;
  std::string machine_sha256;
  double aim_mm = 0, band_min_mm = 0, band_max_mm = 0;
  std::vector<DetectorRow> detectors;
  std::vector<ApproachRow> approaches;
  std::vector<FollowingRow> followings;
  std::vector<BottleRow> bottle;
  std::vector<FaultedTwin> faulted;  ///< approaches, prints

  /// Of the faulted trials: no touch, and no answer that is wrong.
  bool good() const;
};

/// The result does not depend on the number of threads. Throws InputError, MachineError, Interrupted.
GapBenchmark run_gap_benchmark(const GapBenchmarkRequest& request, const Progress& progress = {});

}  // namespace understudy::studies
