// One program on built machines: by a controller that knows the calibration, and compensated for one that
// does not (docs/compensation.md).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/progress.h"
#include "machine/description.h"
#include "rehearsal/compensation/predicted_play.h"

namespace understudy::studies {

struct CompensationStudyRequest {
  std::string machine;  ///< name or path, without a calibration
  int machines = 50;
  std::uint64_t first_seed = 1;
  /// Poses are measured on the machine with its play (sample-poses --engine quasistatic), and plays count
  /// from where they rest; else as if there were no play, and from their middle.
  bool driven = false;
  /// Of the geometry. One that finds the plays (with_play) needs driven poses; plays then count from their
  /// middle.
  std::string estimator = "maximum_likelihood";
  int poses = 24;       ///< measured of each machine
  int threads = 1;      ///< the result does not depend on it
  std::string command;  ///< for the record
};

/// Of a machine's print, RMS over what is extruded. [m]
struct CompensatedPrint {
  std::uint64_t seed = 0;
  double drawn = 0;        ///< the nominal controller and the program as it is
  double calibrated = 0;   ///< the calibrated controller and the program as it is
  double compensated = 0;  ///< the nominal controller and the compensated program
  /// Between the true tip and where the same machine without play would have it, were it told the calibrated
  /// geometry's answer.
  double play_calibrated = 0, play_compensated = 0;
  double predicted = 0;  ///< what `compensate` says of `compensated`
  int rounds = 0;
  int added_lines = 0;
};

struct CompensationStudy {
  CompensationStudyRequest request;
  std::string machine;
  std::vector<CompensatedPrint> prints;

  /// RMS over machines.
  double rms(double CompensatedPrint::*figure) const;
  double ratio() const { return rms(&CompensatedPrint::compensated) / rms(&CompensatedPrint::calibrated); }
  double worst_ratio() const;
  /// Share of the play's part that is gone, of the RMS over machines.
  double play_reduction() const;
};

/// The program of the study: a raster, leaning by up to 10 degrees, and a circle, about the middle of the
/// work space. 20 mm/s.
std::string study_program(const machine::MachineDescription& machine);

/// Throws InputError for a machine that is calibrated, has no tolerances, or cannot run the program, for an
/// estimator that does not calibrate it, and for one that finds plays where the machine is not driven.
CompensationStudy run_compensation_study(const CompensationStudyRequest& request,
                                         const Progress& progress = {});

}  // namespace understudy::studies
