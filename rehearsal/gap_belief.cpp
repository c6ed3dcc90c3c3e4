#include "rehearsal/gap_belief.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "calibration/strut_model.h"

namespace understudy::rehearsal {
namespace {

using control::GapControl;
using control::GapSample;

constexpr double kUnstated = std::numeric_limits<double>::quiet_NaN();

using Rows = Eigen::RowVectorXd;

/// How the calibrated geometry's errors move the tip along the tool axis.
class TipAlongAxis {
 public:
  TipAlongAxis(const machine::MachineDescription& machine, const machine::CalibratedParameters& parameters)
      : machine_(machine) {
    if (machine.is_chain() || parameters.covariance.size() == 0) return;
    const Eigen::Index geometry = unknowns_.count();
    covariance_ = parameters.covariance.topLeftCorner(geometry, geometry);
  }
  bool known() const { return covariance_.size() > 0; }

  /// d (tip along the axis) / d parameters; nothing where the tool cannot go.
  std::optional<Rows> rows(const Pose& X_WT) const {
    const Pose X_BT = machine_.X_WB.inverse() * X_WT;
    calibration::StrutLinearisation at;
    if (!calibration::linearise({machine_.hexapod().geometry, {}}, {}, X_BT, at)) return std::nullopt;
    return Rows(tool_axis(X_BT).transpose() * calibration::pose_rows(at, unknowns_).topRows<3>());
  }
  double variance(const Rows& rows) const {
    return std::max(0.0, (rows * covariance_ * rows.transpose()).value());
  }

 private:
  const machine::MachineDescription& machine_;
  const calibration::Unknowns unknowns_{true, false};  // of the file's rows, those of the geometry
  Eigen::MatrixXd covariance_;
};

/// Goes through the instants of a print, in order of time.
class Beliefs {
 public:
  explicit Beliefs(const GapKnowledge& knowledge)
      : knowledge_(knowledge), tip_(knowledge.machine, knowledge.parameters) {
    if (knowledge.result.following)
      for (const GapSample& sample : knowledge.result.following->samples)
        if (sample.believed_sigma > 0) frames_.push_back(&sample);
  }

  GapBelief at(const CommandedInstant& instant) {
    const auto& approaches = knowledge_.result.approaches;
    for (; approach_ < approaches.size() && approaches[approach_].done_at <= instant.time; ++approach_)
      X_WT_start_.reset();
    if (!X_WT_start_) X_WT_start_ = instant.X_WT;
    if (!instant.extruding) return {knowledge_.machine.gap.aim, kUnstated};
    if (const auto followed = from_frames(instant.time)) return *followed;
    if (approach_ > 0) return from_start(approaches[approach_ - 1].outcome, instant.X_WT);
    return from_geometry(instant.X_WT);
  }

 private:
  double frame_age_max() const { return knowledge_.machine.control.gap.approach.frame_age_max; }  // [s]
  /// Nothing before the first frame of this bead; no sigma where frames are too far apart.
  std::optional<GapBelief> from_frames(double time) {
    while (frame_ < frames_.size() && frames_[frame_]->time <= time) ++frame_;
    const double bead_began = approach_ > 0 ? knowledge_.result.approaches[approach_ - 1].done_at : 0;
    if (frame_ == 0 || frames_[frame_ - 1]->time < bead_began) return std::nullopt;
    const GapSample& before = *frames_[frame_ - 1];
    if (frame_ == frames_.size())
      return GapBelief{before.believed,
                       time - before.time < frame_age_max() ? before.believed_sigma : kUnstated};
    const GapSample& after = *frames_[frame_];
    const double span = after.time - before.time, share = (time - before.time) / span;
    const auto between = [&](double a, double b) { return a + share * (b - a); };
    return GapBelief{
        between(before.believed, after.believed),
        span < frame_age_max() ? between(before.believed_sigma, after.believed_sigma) : kUnstated};
  }

  GapBelief from_start(const control::GapOutcome& start, const Pose& X_WT) const {
    double variance = start.sigma * start.sigma + start.calibration_sigma * start.calibration_sigma;
    if (tip_.known()) {
      const auto here = tip_.rows(X_WT), there = tip_.rows(*X_WT_start_);
      if (!here || !there) return {start.gap, kUnstated};
      variance += tip_.variance(*here - *there);
    }
    return {start.gap, std::sqrt(variance)};
  }

  GapBelief from_geometry(const Pose& X_WT) const {
    const double aim = knowledge_.machine.gap.aim;
    if (!tip_.known()) return {aim, kUnstated};
    const auto rows = tip_.rows(X_WT);
    return {aim, rows ? std::sqrt(tip_.variance(*rows)) : kUnstated};
  }

  const GapKnowledge& knowledge_;
  const TipAlongAxis tip_;
  std::vector<const GapSample*> frames_;
  std::size_t frame_ = 0, approach_ = 0;  // how many are past
  std::optional<Pose> X_WT_start_;        // of the bead
};

}  // namespace

std::vector<GapBelief> gap_beliefs(const GapKnowledge& knowledge,
                                   const std::vector<CommandedInstant>& instants) {
  Beliefs beliefs(knowledge);
  std::vector<GapBelief> all;
  all.reserve(instants.size());
  for (const CommandedInstant& instant : instants) all.push_back(beliefs.at(instant));
  return all;
}

std::string how_stated(const GapKnowledge& knowledge) {
  const bool geometry = TipAlongAxis(knowledge.machine, knowledge.parameters).known();
  if (knowledge.mode == GapControl::off)
    return geometry ? "of the calibrated geometry; of play and of the part it states nothing"
                    : "the controller states none: its machine file has no covariance of the geometry";
  std::string words =
      knowledge.mode == GapControl::continuous ? "of the followed gap" : "of the gap read at the start";
  words += knowledge.machine.gap_sensor
               ? ", noise and calibration of laser and microscope"
               : ", noise alone: its machine file has no gap_sensor, mounts count as exact";
  if (knowledge.mode == GapControl::start)
    words += geometry ? "; along the path, of the calibrated geometry, not of play and of the part"
                      : "; it states nothing of how the gap changes along the path";
  return words;
}

}  // namespace understudy::rehearsal
