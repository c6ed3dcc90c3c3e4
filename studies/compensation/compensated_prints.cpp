#include "studies/compensation/compensated_prints.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include <fmt/format.h>

#include "control/compensation/command_map.h"
#include "control/print.h"
#include "control/program/gcode_options.h"
#include "core/error.h"
#include "core/interrupt.h"
#include "core/parallel.h"
#include "core/units.h"
#include "rehearsal/compensation/compensate.h"
#include "rehearsal/program/program_reading.h"
#include "sim/plant/drive_errors.h"
#include "sim/plant/quasistatic/quasistatic.h"
#include "sim/twin/simulated_port.h"
#include "studies/gap/lab_machine.h"
#include "toolpath/gcode/rewrite/rewritten_path.h"

namespace understudy::studies {
namespace {

using kinematics::AxisVector;
using machine::MachineDescription;

constexpr double kSide = 30;  // [mm], of the raster
constexpr int kRows = 6;
constexpr double kLean = 10;        // [deg], at the raster's ends
constexpr double kFeed = 1200;      // [mm/min]
constexpr double kFilament = 0.04;  // [mm] for a millimetre of path
constexpr const char* kFile = "study.gcode";
constexpr const char* kFindsPlay = "with_play";

/// Where the built machine, without play, has its tip when it is told what the calibration says.
class WithoutPlay {
 public:
  WithoutPlay(const MachineDescription& known, const sim::AsBuilt& built, rehearsal::PlayReference reference)
      : known_(known),
        built_(built),
        mechanism_(known.make_mechanism()),
        X_BW_(known.X_WB.inverse()),
        zero_(known.drive_zero()),
        sampler_(known, built, still()) {
    if (reference == rehearsal::PlayReference::rest) rest_ = sim::QuasistaticSampler(known, built).gap();
    static_cast<void>(mechanism_->inverse(known.X_BT_home, {}, axes_));
  }

  Vec3 tip(const Pose& X_WT_asked) {
    if (mechanism_->inverse(X_BW_ * X_WT_asked, axes_, axes_) != kinematics::SolveStatus::ok)
      throw MachineError("the study's program leaves the calibrated machine's reach");
    sim::PathSample sample;
    for (int i = 0; i < mechanism_->axis_count(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      const sim::DriveError& error = built_.drives[k];
      const double told = axes_[k] - zero_[k];
      const bool exact = error.scale == 0 && error.periodic == 0;
      sample.position[k] = rest_[k] + (exact ? told : sim::axis_travel(error, known_.drives[k].lead, told));
    }
    Pose X_WT;
    if (sampler_.sample(sample, X_WT) != kinematics::SolveStatus::ok)
      throw MachineError("the built machine cannot follow the study's program");
    return X_WT.translation();
  }

 private:
  static sim::QuasistaticOptions still() {
    sim::QuasistaticOptions options;
    options.play = false;
    return options;
  }

  const MachineDescription& known_;
  const sim::AsBuilt& built_;
  std::unique_ptr<kinematics::Mechanism> mechanism_;
  Pose X_BW_;
  AxisVector zero_, rest_{}, axes_{};
  sim::QuasistaticSampler sampler_;
};

class TipErrors : public sim::Observer {
 public:
  TipErrors(const toolpath::RewrittenPath& path, WithoutPlay* without) : path_(path), without_(without) {}

  void observe(const sim::Snapshot& s) override {
    if (s.filament <= filament_) return;
    filament_ = s.filament;
    const Pose asked = path_.asked(s.line, s.X_WT_commanded);
    const Vec3 tip = s.X_WT.translation();
    error_ += (tip - asked.translation()).squaredNorm();
    if (without_ != nullptr) play_ += (tip - without_->tip(asked)).squaredNorm();
    ++count_;
  }
  double error() const { return rms(error_); }
  double play() const { return rms(play_); }

 private:
  double rms(double squares) const { return count_ > 0 ? std::sqrt(squares / count_) : 0; }

  const toolpath::RewrittenPath& path_;
  WithoutPlay* without_;
  double filament_ = 0, error_ = 0, play_ = 0;
  double count_ = 0;
};

/// One controller's print on what stands there.
void print_on(const MachineDescription& controller, const MachineDescription& truth,
              const sim::AsBuilt& built, const toolpath::Program& program, TipErrors& errors) {
  const auto plant = sim::with_drive_errors(sim::make_quasistatic_plant(truth, built), truth, built);
  sim::SimulatedPort port(controller, *plant, sim::Exposure(), {&errors});
  control::PrintOptions options;
  options.gap_control = control::GapControl::off;
  options.poses = control::PoseCheck::solvable;
  const control::PrintResult result = control::print(program, controller, port, options);
  if (!result.completed) throw MachineError(fmt::format("a print of the study stopped: {}", result.stop.why));
}

CompensatedPrint one_machine(const CompensationStudyRequest& request, const MachineDescription& drawn,
                             std::uint64_t seed) {
  const CalibratedGeometry lab = calibrate_lab_geometry(
      drawn, seed, {request.driven ? "quasistatic" : "", request.estimator, request.poses});
  const sim::AsBuilt built = sim::make_as_built(drawn, "manufactured", seed);
  const std::string text = study_program(drawn);
  rehearsal::CompensationRequest asked;
  asked.dialect.temperature_c.reset();
  const bool rests = request.driven && !lab.calibrated.play;
  asked.reference = rests ? rehearsal::PlayReference::rest : rehearsal::PlayReference::middle;
  const rehearsal::Compensation done =
      rehearsal::compensate({drawn, lab.machine, lab.calibrated, text, kFile}, asked);
  const auto options = control::gcode_options({}, drawn);
  const toolpath::Program original = toolpath::parse_gcode(text, kFile, options);
  const Pose home = drawn.X_WB * drawn.X_BT_home;
  const toolpath::RewrittenPath itself(original, original, text, home);
  const toolpath::RewrittenPath rewritten(original, done.program, done.text, home);
  WithoutPlay without(lab.machine, built, asked.reference);
  TipErrors of_drawn(itself, nullptr), of_calibrated(itself, &without), of_compensated(rewritten, &without);
  print_on(drawn, drawn, built, original, of_drawn);
  print_on(lab.machine, drawn, built, original, of_calibrated);
  print_on(drawn, drawn, built, done.program, of_compensated);
  return {seed,
          of_drawn.error(),
          of_calibrated.error(),
          of_compensated.error(),
          of_calibrated.play(),
          of_compensated.play(),
          done.predicted,
          done.rounds,
          done.added_lines};
}

}  // namespace

double CompensationStudy::rms(double CompensatedPrint::*figure) const {
  double squares = 0;
  for (const CompensatedPrint& print : prints) squares += print.*figure * (print.*figure);
  return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, prints.size())));
}

double CompensationStudy::worst_ratio() const {
  double worst = 0;
  for (const CompensatedPrint& print : prints) worst = std::max(worst, print.compensated / print.calibrated);
  return worst;
}

double CompensationStudy::play_reduction() const {
  const double before = rms(&CompensatedPrint::play_calibrated);
  return before > 0 ? 1 - rms(&CompensatedPrint::play_compensated) / before : 0;
}

std::string study_program(const MachineDescription& machine) {
  const Vec3 middle =
      1e3 * (machine.is_chain() ? Vec3(0, 0, 0.05) : Vec3((machine.X_WB * machine.X_BT_home).translation()));
  std::string text = "; a leaning raster and a circle\nG21\nG90\nM82\nM104 S210\n";
  double e = 0;
  const auto lean = [](double x) {
    const double half = from_deg(kLean * x / (kSide / 2)) / 2;
    return fmt::format("W{:.9f} I0 J{:.9f} K0", std::cos(half), std::sin(half));
  };
  const auto at = [&](const char* code, double x, double y, double turn_x) {
    return fmt::format("{} X{:.4f} Y{:.4f} Z{:.4f} {}", code, middle.x() + x, middle.y() + y, middle.z(),
                       lean(turn_x));
  };
  for (int row = 0; row < kRows; ++row) {
    const double y = kSide * (row / (kRows - 1.0) - 0.5), x = (row % 2 == 0 ? -1 : 1) * kSide / 2;
    text += at("G0", x, y, x) + "\n";
    text += at("G1", -x, y, -x) + fmt::format(" E{:.5f} F{:.0f}\n", e += kFilament * kSide, kFeed);
  }
  const double radius = kSide / 2;
  text += at("G0", radius, 0, 0) + "\n";
  e += kFilament * 2 * std::numbers::pi * radius;
  text += fmt::format("G2 I{:.4f} J0 E{:.5f} F{:.0f} ; once round\nM30\n", -radius, e, kFeed);
  return text;
}

CompensationStudy run_compensation_study(const CompensationStudyRequest& request, const Progress& progress) {
  const MachineDescription drawn = machine::load_machine(request.machine);
  if (drawn.calibration)
    throw InputError(fmt::format("{}: is calibrated; the study builds and calibrates machines of a drawing",
                                 request.machine));
  if (request.estimator == kFindsPlay && !request.driven)
    throw InputError(
        fmt::format("{} finds plays in poses that a machine was driven to: add --driven", kFindsPlay));
  CompensationStudy study;
  study.request = request;
  study.machine = drawn.name;
  study.prints.resize(static_cast<std::size_t>(request.machines));
  const auto run = [&](std::size_t i) {
    stop_if_interrupted();
    study.prints[i] = one_machine(request, drawn, request.first_seed + i);
  };
  in_parallel(study.prints.size(), request.threads, run, [&](std::size_t, std::size_t done) {
    if (progress)
      progress(static_cast<double>(done) / request.machines,
               fmt::format("machine {} of {}", done, request.machines));
  });
  return study;
}

}  // namespace understudy::studies
