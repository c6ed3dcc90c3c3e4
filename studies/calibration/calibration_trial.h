// One problem of the calibration benchmark: a built machine, measured under a condition, given to every
// entrant; the truth is kept for the judge.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "calibration/estimators/estimator.h"
#include "machine/description.h"
#include "studies/calibration/estimator_study.h"
#include "studies/calibration/pixel_measurement.h"

namespace understudy::studies {

/// What is wrong beside the measurement's stated noise. One at a time.
enum class Disturbance {
  none,
  outliers,  ///< an eighth of the poses, at least one, off by 1 mm and 10 mrad more (1 sigma per axis)
  boards,    ///< the measuring frame off by 50 um and 0.5 mrad, its scale by 0.05 % (1 sigma), the same in
             ///< all poses; from pixels, boards misplaced by 0.2 mm and 2 mrad, each on its own
  play,  ///< half to one and a half of the nominal play in every strut or axis, approached from both sides
  deviation,  ///< dev is 1 mm smaller than the model's
  drift       ///< screws warm by 20 K during the measurement; the machine is judged warm
};
const char* to_string(Disturbance d);
const std::vector<Disturbance>& all_disturbances();
/// Throws InputError that names the nearest known one.
Disturbance disturbance_named(const std::string& word);

struct Condition {
  calibration::MeasurementNoise noise;  ///< from pixels not used
  std::size_t poses = 12;
  Disturbance disturbance = Disturbance::none;
};

/// Who solves. What is a plug-in and what is ours matters to the page alone.
struct Method {
  std::string name;
  bool plugin = false;
  std::shared_ptr<const calibration::Estimator> estimator;  ///< none: a bundle adjustment
  bool with_play = false;                                   ///< of a bundle adjustment
};

/// "bundle" and "bundle_with_play": on the plant, from pixels, only.
const std::vector<std::string>& bundle_names();

/// Errors of the tip at the poses held out, against what was stated of them.
struct StatedErrors {
  std::vector<double> errors;      ///< [m]
  std::vector<double> stated;      ///< [m], 1 sigma of the 3D error; empty: nothing is stated
  std::vector<double> normalised;  ///< e^T C^-1 e, of three degrees of freedom
};

struct Answer {
  std::string failure;         ///< one line; empty: solved
  std::vector<double> errors;  ///< [m], of the tip at the poses held out
  double seconds = 0;          ///< wall time
  /// On the plant: the same, and without the rigid motion of W that other poses tell.
  StatedErrors in_frame{}, registered{};
  double misfit = 0;  ///< of a bundle adjustment: residuals over their stated noise; 0: none
  bool ok() const { return failure.empty(); }
};

/// Why it is no answer, without figures that differ from machine to machine; empty where it is one.
std::string failure_of(const calibration::Estimation& found);

struct Trial {
  double bound = 0;                  ///< [m], Cramer-Rao bound's RMS of the tip; 0: none
  std::vector<double> uncalibrated;  ///< [m], as Answer::errors, of the nominal model
  std::vector<Answer> answers;       ///< one an entrant
  int lost_poses = 0;                ///< that could not be measured
  double beyond = 0;                 ///< [m], a target's farthest distance outside of the layers (pixels)
};

struct TrialSetting {
  const machine::MachineDescription* machine = nullptr;
  std::vector<Method> entrants;
  PoseChoice choice = PoseChoice::random;
  std::uint64_t seed = 1;
  std::size_t held_out = 60;
  /// On the plant where set (sessions: PlantSession), from pixels, each machine before a stand of its own.
  std::string engine;
  StandOptions stand_options;
  /// From pixels without a plant where set: the stand, and the one with misplaced boards where that is asked
  /// for.
  const MeasuringStand* stand = nullptr;
  const MeasuringStand* misplaced_stand = nullptr;
};

/// A trial is a function of (setting, condition, machine number) but for its wall times.
class TrialRunner {
 public:
  virtual ~TrialRunner() = default;
  /// `view` is for pixels only; it belongs to the calling thread.
  virtual Trial run(const Condition& condition, int machine, renderer::CalibrationView* view) const = 0;
};
std::unique_ptr<TrialRunner> make_hexapod_trials(const TrialSetting& setting);
/// Of a hexapod that is driven on a plant and photographed.
std::unique_ptr<TrialRunner> make_plant_trials(const TrialSetting& setting);
/// Of an open chain. Throws InputError for pixels.
std::unique_ptr<TrialRunner> make_chain_trials(const TrialSetting& setting);

/// A problem whose answer leaves the machine worse than it was is not solved.
void judge(const std::vector<double>& uncalibrated, Answer& answer);

}  // namespace understudy::studies
