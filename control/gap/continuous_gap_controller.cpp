#include "control/gap/continuous_gap_controller.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "control/motion/path_segment.h"
#include "core/error.h"
#include "core/units.h"
#include "geometry/mesh.h"

namespace understudy::control {

using machine::Setpoint;
using machine::Status;

namespace {

constexpr double kMargin = 0.015;          // [s] of motion left in the queue when a frame has come
constexpr double kRemembered = 0.5;        // [s], of setpoints: a frame that is older is stale
constexpr double kPause = 0.01;            // [s], between looks whether the bead has begun
constexpr double kExpected = 0.15e-3;      // [m], about the estimate, that the picture shows
constexpr double kSurfaceRadius = 2.5e-3;  // [m], as at the approach
constexpr double kSameHeight = 50e-6;      // [m]: a bead programmed higher over the part lies on other beads
constexpr double kReportEvery = 0.01;      // [s], offsets for observers
constexpr double kReportChange = 0.2e-6;   // [m]
constexpr int kPicturesMax = 40;

}  // namespace

ContinuousGapController::ContinuousGapController(const machine::MachineDescription& machine,
                                                 const geometry::Mesh* part, const DepositedBeadMap& laid,
                                                 const GapControllerOptions& approach,
                                                 const GapFollowerOptions& options,
                                                 machine::MachinePort& port, Report report)
    : machine_(machine),
      part_(part),
      laid_(laid),
      options_(options),
      port_(port),
      report_(std::move(report)),
      mechanism_(machine.make_mechanism()),
      eye_(machine, surface_, approach, port),
      follower_(options),
      ring_(static_cast<std::size_t>(std::ceil(kRemembered / machine.cycle_time))) {}

ContinuousGapController::~ContinuousGapController() = default;

double ContinuousGapController::lead() const {
  return machine_.microscope.exposure + machine_.microscope.transfer + kMargin;
}

void ContinuousGapController::start(const Vec3& offset_W, double gap, double sigma) {
  start_unknown(offset_W);
  follower_.start(port_.now(), 0, gap, sigma);
}

void ContinuousGapController::start_unknown(const Vec3& offset_W) {
  active_ = true;
  measurable_ = false;
  height_known_ = false;
  still_dot_.reset();
  offset_W_ = reported_W_ = offset_W;
  correction_ = 0;
  filled_ = head_ = 0;
  shift_before_ = shift_held_ = {};
  follower_.start_unknown(port_.now(), 0);
}

double ContinuousGapController::release() {
  const double standing = correction_;
  active_ = holding_ = false;
  correction_ = 0;
  shift_before_ = shift_held_ = {};
  return standing;
}

double ContinuousGapController::filament_at(double time) const {
  Passed at;
  if (passed_at(time, at)) return at.filament;
  return filled_ > 0 ? passed(0).filament : 0;
}

/// Straight between the two points around it. False: not remembered.
bool ContinuousGapController::passed_at(double time, Passed& at) const {
  if (filled_ == 0 || time < passed(filled_ - 1).time) return false;
  if (time >= passed(0).time) {
    at = passed(0);
    return true;
  }
  std::size_t newer = 0, older = filled_ - 1;  // steps back
  while (older - newer > 1) {
    const std::size_t middle = (newer + older) / 2;
    (passed(middle).time > time ? newer : older) = middle;
  }
  const Passed &a = passed(older), &b = passed(newer);
  const double share = (time - a.time) / (b.time - a.time);
  const auto between = [&](double from, double to) { return from + share * (to - from); };
  at = b;
  at.time = time;
  at.path = between(a.path, b.path);
  at.correction = between(a.correction, b.correction);
  at.filament = between(a.filament, b.filament);
  at.X_WT = interpolate(a.X_WT, b.X_WT, share);
  return true;
}

/// The path counts the tip's travel and its turns, as a motion's own parameter does.
void ContinuousGapController::remember(const PlannedPoint& point) {
  Passed next;
  next.time = point.setpoint.time;
  next.X_WT = point.X_WT;
  next.filament = point.setpoint.filament;
  next.line = point.setpoint.line;
  if (filled_ > 0) {
    const Passed& last = passed(0);
    const double way = std::max((next.X_WT.translation() - last.X_WT.translation()).norm(),
                                kTurnRadius * angle_between(next.X_WT.linear(), last.X_WT.linear()));
    next.path = last.path + way;
    next.printing = next.filament > last.filament && way > 0;
    if (!next.printing) follower_.pass(next.time - last.time, way);
  }
  const double dt = machine_.cycle_time;
  const auto correction =
      follower_.advance(dt, next.path, next.printing && measurable_ && following_.stop == GapStop::none);
  correction_ = next.correction = correction.value;
  ring_[head_] = next;
  head_ = (head_ + 1) % ring_.size();
  filled_ = std::min(filled_ + 1, ring_.size());
}

/// By how much the axes move for a shift along the tool axis. False: they cannot.
bool ContinuousGapController::axes_shift(const PlannedPoint& point, double correction,
                                         kinematics::AxisVector& shift) {
  shift = {};
  if (correction == 0) return true;
  const auto axes = static_cast<std::size_t>(mechanism_->axis_count());
  const Pose X_BW = machine_.X_WB.inverse();
  Pose X_WT = point.X_WT;
  X_WT.translation() += correction * tool_axis(X_WT);
  kinematics::AxisVector plain = point.setpoint.position, shifted = point.setpoint.position;
  const std::span<double> from(plain.data(), axes), to(shifted.data(), axes);
  violations_.clear();
  const bool solved = mechanism_->inverse(X_BW * point.X_WT, from, from) == kinematics::SolveStatus::ok &&
                      mechanism_->inverse(X_BW * X_WT, to, to) == kinematics::SolveStatus::ok;
  if (solved) mechanism_->check(X_BW * X_WT, to, violations_);
  if (!solved || !violations_.empty()) return false;
  for (std::size_t i = 0; i < axes; ++i) shift[i] = shifted[i] - plain[i];
  return true;
}

bool ContinuousGapController::shift(const PlannedPoint& point, Setpoint& ready) {
  kinematics::AxisVector shift{};
  if (active_) {
    remember(point);
    if (!axes_shift(point, correction_, shift)) {
      const std::string limit = violations_.empty() ? "no axes reach it" : to_string(violations_.front());
      raise_stop(GapStop::unreachable,
                 fmt::format("with {:+.3f} mm along the tool's axis {}", to_mm(correction_), limit),
                 passed(0));
      shift = shift_held_;
    }
    const Vec3 offset_W = offset_W_ + correction_ * tool_axis(point.X_WT);
    if (report_ && point.setpoint.time >= reported_at_ + kReportEvery &&
        (offset_W - reported_W_).norm() > kReportChange) {
      report_(point.setpoint.time, point.setpoint.line, offset_W);
      reported_at_ = point.setpoint.time;
      reported_W_ = offset_W;
    }
  }
  const bool complete = holding_;
  if (complete) {
    // The shift's own velocity by central difference: it is smooth over many cycles.
    const double span = point.setpoint.time - time_before_;
    if (active_ && span < 3 * machine_.cycle_time)
      for (std::size_t i = 0; i < shift.size(); ++i)
        held_.velocity[i] += (shift[i] - shift_before_[i]) / span;
    ready = held_;
  }
  time_before_ = complete ? held_.time : point.setpoint.time - machine_.cycle_time;
  shift_before_ = complete ? shift_held_ : shift;
  shift_held_ = shift;
  held_ = point.setpoint;
  for (std::size_t i = 0; i < shift.size(); ++i) held_.position[i] += shift[i];
  holding_ = true;
  return complete;
}

/// The last of a stretch is at rest, and the correction with it.
bool ContinuousGapController::flush(Setpoint& ready) {
  if (!holding_) return false;
  ready = held_;
  holding_ = false;
  shift_before_ = shift_held_;
  return true;
}

Status ContinuousGapController::pass_time(double until) {
  Passed expected;
  const auto& microscope = machine_.microscope;
  const bool due = active_ && passed_at(port_.now() + 0.5 * microscope.exposure, expected) &&
                   expected.printing &&
                   passed(0).time > port_.now() + microscope.exposure + microscope.transfer;
  const double pause = std::min(until, port_.now() + kPause);
  if (!due) return port_.wait_until(pause);
  const bool measurable = find_surface(expected);
  if (measurable && !measurable_) follower_.resume(expected.time, expected.path);
  measurable_ = measurable;
  return measurable ? look(expected) : port_.wait_until(pause);
}

/// The nominal part under the programmed pose. False: it ends here, or what lies there are beads.
bool ContinuousGapController::find_surface(const Passed& at) {
  Pose X_WT = at.X_WT;
  X_WT.translation() -= offset_W_;
  if (!part_) return dot_on_ground(machine_, surface_, laid_, X_WT, machine_.gap.aim, at.line);
  const auto height = height_over(*part_, X_WT, kSurfaceRadius);
  if (!height) return false;
  if (!height_known_) height_at_start_ = *height;
  height_known_ = true;
  if (std::abs(*height - height_at_start_) > kSameHeight) return false;
  try {
    surface_ = local_surface(*part_, X_WT, kSurfaceRadius);
  } catch (const InputError&) {  // an edge within the radius: no slope to read with
    return false;
  }
  return dot_on_ground(machine_, surface_, laid_, X_WT, *height, at.line);
}

Status ContinuousGapController::look(const Passed& expected) {
  GapSample look;
  Passed at = expected;
  const double asked_at = port_.now();
  const GapStop seen = read(expected, look, at);
  if (port_.state().fault != machine::Fault::none) return Status::faulted;
  ++following_.frames;
  judge(look, seen, at);
  if (follower_.stop() != GapStop::none && following_.stop == GapStop::none) raise_follower_stop(look, at);
  following_.gap = follower_.gap(at.correction);
  following_.sigma = follower_.sigma();
  keep(std::move(look));
  // A camera that refuses at once must not hold the clock.
  return port_.now() > asked_at ? Status::ok : port_.wait_until(asked_at + kPause);
}

/// `at` is what was commanded in the middle of the exposure.
GapStop ContinuousGapController::read(const Passed& expected, GapSample& look, Passed& at) {
  const double gap = follower_.known() ? follower_.predicted_gap(expected.path, expected.correction)
                                       : 0.5 * (machine_.gap.accepted_min + machine_.gap.accepted_max);
  const double bound = follower_.known() ? kExpected : 2 * kExpected;
  const double queued = passed(0).time - port_.now() - machine_.cycle_time;
  if (const GapStop s = eye_.expose_around({gap, bound}, queued, look); s != GapStop::none) return s;
  if (!passed_at(look.time, at)) {
    look.why = fmt::format("frame {} is older than {:.1f} s", look.frame.number, kRemembered);
    return GapStop::stale_frame;
  }
  return eye_.read(look);
}

void ContinuousGapController::judge(GapSample& look, GapStop seen, const Passed& at) {
  if (seen != GapStop::none) {
    follower_.miss(at.time, at.path, seen);
    return;
  }
  const double expected = follower_.predicted_gap(at.path, at.correction);
  const GapObservation seen_there{
      at.time, at.path, at.correction, look.reading.gap, look.reading.sigma, still_reading(look.dot)};
  switch (follower_.observe(seen_there)) {
    case GapVerdict::used:
      look.used = true;
      ++following_.used;
      break;
    case GapVerdict::not_yet:
      look.why = "the first readings are gathered";
      break;
    case GapVerdict::repeated:
      look.why = "the reading repeats to the last digit: the picture stands still";
      break;
    case GapVerdict::jump:
      look.why = fmt::format("the gap reads {:.3f} mm where {:.3f} mm were expected, 1 sigma {:.3f} mm",
                             to_mm(look.reading.gap), to_mm(expected), to_mm(look.reading.sigma));
      break;
  }
}

/// What a spot that has not moved in the picture would read on the surface as it is now.
double ContinuousGapController::still_reading(const vision::DotMeasurement& dot) {
  GapReading still;
  if (still_dot_ && read_gap(machine_, surface_, *still_dot_, still)) return still.gap;
  still_dot_ = dot;
  return std::nan("");
}

void ContinuousGapController::raise_follower_stop(const GapSample& look, const Passed& at) {
  const GapStop reason = follower_.stop();
  std::string why;
  if (reason == GapStop::too_close && look.used)
    why = fmt::format("the gap is {:.3f} mm, 1 sigma {:.3f} mm: less than {:.3f} mm may be left",
                      to_mm(follower_.gap(at.correction)), to_mm(follower_.sigma()), to_mm(options_.floor));
  else if (reason == GapStop::too_far && look.used)
    why = fmt::format("the surface lies {:.3f} mm off the programmed one, at most {:.3f} mm are followed",
                      to_mm(-follower_.wanted()), to_mm(options_.travel_max));
  else if (reason == GapStop::no_progress && look.used)
    why = fmt::format(
        "the gap reads {:.3f} mm and has not followed the tool, which may come nearer by {:.3f} mm "
        "until it does: what shines may not be the dot",
        to_mm(look.reading.gap), to_mm(options_.unproved_max));
  else
    why = fmt::format("{} looks in {:.2f} s could not be used; the last: {}", follower_.missed(),
                      at.time - follower_.blind_since(), look.why);
  raise_stop(reason, std::move(why), at);
}

void ContinuousGapController::raise_stop(GapStop reason, std::string why, const Passed& at) {
  if (following_.stop != GapStop::none) return;
  following_.stop = reason;
  following_.why = std::move(why);
  following_.line = at.line;
  following_.time = port_.now();
}

/// Every look stays; of the pictures every other one goes whenever there are too many.
void ContinuousGapController::keep(GapSample look) {
  auto& looks = following_.looks;
  const auto stride = static_cast<std::size_t>(picture_stride_);
  if (looks.size() % stride != 0) look.frame.image.pixels = {};
  looks.push_back(std::move(look));
  if (looks.size() < stride * kPicturesMax) return;
  picture_stride_ *= 2;
  for (std::size_t i = 0; i < looks.size(); ++i)
    if (i % (2 * stride) != 0) looks[i].frame.image.pixels = {};
}

}  // namespace understudy::control
