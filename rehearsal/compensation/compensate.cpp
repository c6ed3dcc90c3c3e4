#include "rehearsal/compensation/compensate.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "control/motion/constraint_check.h"
#include "control/program/gcode_options.h"
#include "core/digest.h"
#include "core/error.h"
#include "core/file/read_file.h"
#include "core/text/printable.h"
#include "core/units.h"
#include "rehearsal/before_calibration.h"
#include "rehearsal/compensation/smoothed_play.h"
#include "rehearsal/findings/findings.h"
#include "rehearsal/program/program_reading.h"
#include "toolpath/gcode/rewrite/gcode_rewrite.h"
#include "toolpath/gcode/rewrite/rewritten_path.h"
#include "toolpath/robot/robot_program.h"

namespace understudy::rehearsal {
namespace {

// [m] of path before and behind a place over which a correction is averaged. A step of it is a corner, before
// which the planner brakes; and braking pushes plays about.
constexpr double kSmoothing[] = {4e-3, 2e-3};
constexpr double kNoGain = 0.02;       // of the error; less is not worth another path
constexpr double kLeastGain = 0.2e-6;  // [m], nor is this
constexpr std::size_t kRounds = 3;     // for each; more of them move the error by its own scatter only
constexpr std::size_t kAllRounds = kRounds * std::size(kSmoothing) + 1;

/// The correction of one run of the path: a reach, and how many of its predictions; none: no correction.
struct RunChoice {
  std::size_t reach = 0, predictions = 0;
  double square = std::numeric_limits<double>::infinity();  // [m^2], predicted
};

/// Takes it for each run in which it is predicted to be better than what is chosen so far.
void choose(const SmoothedPlay& correction, const PlayPrediction& prediction, RunChoice choice,
            std::vector<RunChoice>& choices) {
  std::vector<double> squares(choices.size());
  for (std::size_t step = 0; step < prediction.squares.size(); ++step)
    squares[correction.run(step)] += prediction.squares[step];
  for (std::size_t run = 0; run < squares.size(); ++run) {
    choice.square = squares[run];
    if (choice.square < choices[run].square) choices[run] = choice;
  }
}

class Compensator {
 public:
  Compensator(const CompensationInput& input, const CompensationRequest& request, const Progress& progress)
      : input_(input), request_(request), progress_(progress) {
    if (request.dialect.turn_deg != 0 || request.dialect.spin_deg != 0)
      throw InputError("--turn and --spin: a compensated program stays where its own words put it");
    options_ = control::gcode_options(request.dialect, input.nominal);
    original_ = toolpath::parse_gcode(input.text, input.file, options_);
    lines_ = toolpath::lines_that_place(input.text, input.file, options_);
    home_ = input.nominal.X_WB * input.nominal.X_BT_home;
    require_limits(original_, input.known, "", nullptr);
  }

  Compensation run() {
    Compensation best = written({});
    const sim::AsBuilt built = known_machine(input_.known, input_.parameters, request_.reference);
    const double before = predicted(original_, input_.text, built).tip_rms;
    const double geometry = predicted(best.program, best.text, built).tip_rms;
    best.predicted = geometry;
    if (request_.play) correct_play(built, best);
    best.predicted_before = before;
    best.predicted_geometry = geometry;
    require_limits(best.program, input_.nominal, "as compensated, ", &best);
    return best;
  }

 private:
  /// The best of some rounds, and of a last one with each run's own best. Correcting a play moves the drives
  /// otherwise, which may push it elsewhere.
  void correct_play(const sim::AsBuilt& built, Compensation& best) const {
    std::vector<SmoothedPlay> corrections;
    for (const double reach : kSmoothing) corrections.emplace_back(original_, home_, reach);
    const PlayPrediction without = predicted(best.program, best.text, built);
    std::vector<RunChoice> choices(corrections[0].runs());
    choose(corrections[0], without, {}, choices);
    int round = 0;
    const auto try_round = [&](const control::Correction& correction) {
      if (progress_) progress_(0.1 + 0.9 * round / static_cast<double>(kAllRounds), "predicting play");
      Compensation now = written(correction);
      PlayPrediction prediction = predicted(now.program, now.text, built);
      now.predicted = prediction.tip_rms;
      now.rounds = ++round;
      if (now.predicted < (1 - kNoGain) * best.predicted - kLeastGain) best = std::move(now);
      return prediction;
    };
    for (std::size_t reach = 0; reach < corrections.size(); ++reach) {
      corrections[reach].add(without.play);
      for (std::size_t k = 1; k <= kRounds; ++k) {
        PlayPrediction prediction = try_round([&](std::size_t step, double fraction) {
          return Twist(-corrections[reach].at(step, fraction, k));
        });
        choose(corrections[reach], prediction, {reach, k}, choices);
        corrections[reach].add(std::move(prediction.play));
      }
    }
    try_round([&](std::size_t step, double fraction) {
      const RunChoice& choice = choices[corrections[0].run(step)];
      return Twist(-corrections[choice.reach].at(step, fraction, choice.predictions));
    });
  }

  PlayPrediction predicted(const toolpath::Program& program, const std::string& text,
                           const sim::AsBuilt& built) const {
    const toolpath::RewrittenPath path(original_, program, text, home_);
    return predict_play(program, path, input_.nominal, input_.known, built);
  }

  Compensation written(const control::Correction& correction) const {
    const toolpath::MovedLines moved = control::compensated_lines(
        original_, lines_, {input_.nominal, input_.known, correction, request_.tolerance_um * kMicrometre});
    Compensation result;
    result.text = toolpath::rewrite_gcode(input_.text, input_.file, options_, moved);
    result.program = toolpath::parse_gcode(result.text, input_.file, options_);
    result.lines = static_cast<int>(moved.size());
    for (const auto& [line, pieces] : moved) result.added_lines += static_cast<int>(pieces.size()) - 1;
    for (const toolpath::Step& step : original_.steps) {
      if (!toolpath::moves(step)) continue;
      const auto line = moved.find(step.line);
      if (line == moved.end()) {
        ++result.kept_moves;
        continue;
      }
    }
    const toolpath::RewrittenPath path(original_, result.program, result.text, home_);
    for (std::size_t i = 0; i < result.program.steps.size(); ++i) {
      const toolpath::Step& step = result.program.steps[i];
      if (toolpath::moves(step))
        result.largest_move =
            std::max(result.largest_move,
                     (step.X_WT.translation() - path.asked(path.place(i, 1)).translation()).norm());
    }
    return result;
  }

  /// Lines of a compensated program are told as those of the original.
  void require_limits(const toolpath::Program& program, const machine::MachineDescription& machine,
                      const char* how, const Compensation* written) const {
    for (const Finding& finding : findings_of(control::check_constraints(program, machine))) {
      if (finding.severity != Severity::error) continue;
      int line = finding.gcode_line;
      if (written != nullptr && line > 0)
        line = toolpath::RewrittenPath(original_, program, written->text, home_).original_line(line);
      throw InputError(Place{input_.file, line},
                       fmt::format("{}on {}: {}", how,
                                   written != nullptr ? "the nominal machine" : "the calibrated machine",
                                   finding.message));
    }
  }

  const CompensationInput& input_;
  const CompensationRequest& request_;
  const Progress& progress_;
  toolpath::GcodeOptions options_;
  toolpath::Program original_;
  std::vector<int> lines_;
  Pose home_;
};

}  // namespace

Compensation compensate(const CompensationInput& input, const CompensationRequest& request,
                        const Progress& progress) {
  return Compensator(input, request, progress).run();
}

machine::MachineDescription as_drawn(const machine::MachineDescription& calibrated) {
  if (!calibrated.calibration)
    throw InputError(
        fmt::format("{}: this machine file has no calibration, so there is nothing to compensate: "
                    "understudy calibrate makes one, or --nominal names the machine before it",
                    calibrated.file.string()));
  machine::MachineDescription drawn = calibrated;
  drawn.calibration.reset();
  if (!drawn.is_chain()) {
    drawn.hexapod().geometry = drawn.hexapod().design;
    return drawn;
  }
  kinematics::ChainDescription& chain = drawn.chain().kinematics;
  chain.chain = std::exchange(chain.design, {});
  drawn.X_BT_home = kinematics::forward(chain.chain, chain.home);
  return drawn;
}

Compensation compensate(const CompensationRequest& request, const Progress& progress) {
  machine::CalibratedParameters parameters, unused;
  const auto known = machine::load_machine(request.machine, parameters);
  const auto nominal =
      request.nominal.empty() ? as_drawn(known) : machine::load_machine(request.nominal, unused);
  if (!request.nominal.empty())
    require_same_machine(nominal, known, "--nominal " + request.nominal, request.machine);
  const std::string text = read_file(request.program);
  if (toolpath::robot_language(request.program, text))
    throw InputError(
        fmt::format("{}: a robot's program; G-code is compensated, KRL and RAPID are not", request.program));
  Compensation done =
      compensate(CompensationInput{nominal, known, parameters, text, request.program}, request, progress);
  if (!done.text.ends_with('\n')) done.text += '\n';
  done.text += toolpath::origin_comment({printable(request.program), sha256_hex(text)}) + "\n";
  return done;
}

}  // namespace understudy::rehearsal
