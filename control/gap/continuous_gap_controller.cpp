#include "control/gap/continuous_gap_controller.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "control/motion/path_segment.h"
#include "core/units.h"

namespace understudy::control {

using machine::Setpoint;
using machine::Status;

namespace {

constexpr double kMargin = 0.015;         // [s] of motion left in the queue when a frame has come
constexpr double kRemembered = 0.5;       // [s], of setpoints: a frame that is older is stale
constexpr double kPause = 0.01;           // [s], between two checks whether the bead has begun
constexpr double kExpected = 0.15e-3;     // [m], about the estimate, that the picture shows
constexpr double kSameHeight = 50e-6;     // [m]: a bead programmed higher over the part lies on other beads
constexpr double kReportEvery = 0.01;     // [s], offsets for observers
constexpr double kReportChange = 0.2e-6;  // [m]
constexpr std::size_t kOffsetsMax = 256;  // of one cycle: a batch of setpoints
constexpr int kPicturesMax = 40;

}  // namespace

ContinuousGapController::ContinuousGapController(const machine::MachineDescription& machine,
                                                 const PrintedPart& part, const ContinuousGapOptions& options,
                                                 machine::MachinePort& port, Report report)
    : machine_(machine),
      part_(part),
      options_(options),
      port_(port),
      report_(std::move(report)),
      sensor_(machine, surface_, options_.sensing, port),
      follower_(options.following),
      history_(kRemembered, machine.cycle_time),
      filter_(machine) {
  offsets_.reserve(kOffsetsMax);
}

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
  history_.clear();
  filter_.restart();
  follower_.start_unknown(port_.now(), 0);
}

double ContinuousGapController::release() {
  const double standing = correction_;
  active_ = false;
  correction_ = 0;
  filter_.drop();
  return standing;
}

double ContinuousGapController::filament_at(double time) const {
  Commanded at;
  if (history_.at(time, at)) return at.filament;
  return history_.empty() ? 0 : history_.latest().filament;
}

Status ContinuousGapController::read(double until) {
  Commanded expected;
  const auto& microscope = machine_.microscope;
  const bool due = active_ && history_.at(port_.now() + 0.5 * microscope.exposure, expected) &&
                   expected.printing &&
                   history_.latest().time > port_.now() + microscope.exposure + microscope.transfer;
  const double pause = std::min(until, port_.now() + kPause);
  if (!due) return port_.wait_until(pause);
  const bool measurable = find_surface(expected);
  if (measurable && !measurable_) follower_.resume(expected.time, expected.path);
  measurable_ = measurable;
  return measurable ? take_frame(expected) : port_.wait_until(pause);
}

/// The nominal part under the programmed pose. False: it ends here, or what lies there are beads.
bool ContinuousGapController::find_surface(const Commanded& at) {
  Pose X_WT = at.X_WT;
  X_WT.translation() -= offset_W_;
  if (!part_.mesh) return dot_on_ground(machine_, surface_, part_.beads, X_WT, machine_.gap.aim, at.line);
  const auto height = height_over(*part_.mesh, X_WT);
  if (!height) return false;
  if (!height_known_) height_at_start_ = *height;
  height_known_ = true;
  if (std::abs(*height - height_at_start_) > kSameHeight) return false;
  const auto surface = find_local_surface(*part_.mesh, X_WT);
  if (!surface) return false;  // an edge within the radius: no slope to read with
  surface_ = *surface;
  return dot_on_ground(machine_, surface_, part_.beads, X_WT, *height, at.line);
}

Status ContinuousGapController::take_frame(const Commanded& expected) {
  const double asked_at = port_.now();
  reading_.sample = {};
  reading_.at = expected;
  reading_.seen = sense(expected);
  if (port_.state().fault != machine::Fault::none) return Status::faulted;
  reading_.fresh = true;
  reading_.taken_at = port_.now();
  // A camera that refuses at once must not hold the clock.
  return port_.now() > asked_at ? Status::ok : port_.wait_until(asked_at + kPause);
}

GapStop ContinuousGapController::sense(const Commanded& expected) {
  GapSample& sample = reading_.sample;
  safe_ = safe_aim(machine_, surface_, options_.following.aim);
  follower_.aim_at(safe_.gap, safe_.sigma);
  if (!safe_.fits) {
    follower_.give_up();
    return GapStop::uncertain;
  }
  const double gap = follower_.known() ? follower_.predicted_gap(expected.path, expected.correction)
                                       : 0.5 * (machine_.gap.accepted_min + machine_.gap.accepted_max);
  const double bound = follower_.known() ? kExpected : 2 * kExpected;
  const double queued = history_.latest().time - port_.now() - machine_.cycle_time;
  if (const GapStop s = sensor_.expose_around({gap, bound}, queued, sample); s != GapStop::none) return s;
  if (!history_.at(sample.time, reading_.at)) {
    sample.why = fmt::format("frame {} is older than {:.1f} s", sample.frame.number, kRemembered);
    return GapStop::stale_frame;
  }
  return sensor_.read(sample);
}

void ContinuousGapController::update() {
  if (!reading_.fresh) return;
  reading_.fresh = false;
  reading_.judged = true;
  ++following_.frames;
  judge();
  if (follower_.stop() != GapStop::none) raise(follower_.stop(), reading_.at, reading_.taken_at);
  following_.gap = follower_.gap(reading_.at.correction);
  following_.sigma = follower_.sigma();
  note_belief();
}

/// Also after a frame that could not be used: the estimate goes on, less sure.
void ContinuousGapController::note_belief() {
  const Commanded& at = reading_.at;
  if (!follower_.known() || at.time != reading_.sample.time) return;
  reading_.sample.believed = follower_.predicted_gap(at.path, at.correction);
  reading_.sample.believed_sigma = std::hypot(follower_.predicted_sigma(at.time, at.path), safe_.sigma);
}

void ContinuousGapController::judge() {
  const Commanded& at = reading_.at;
  GapSample& sample = reading_.sample;
  if (reading_.seen != GapStop::none) {
    follower_.miss(at.time, at.path, reading_.seen);
    return;
  }
  reading_.expected = follower_.predicted_gap(at.path, at.correction);
  const GapObservation seen_there{at.time,
                                  at.path,
                                  at.correction,
                                  sample.reading.gap,
                                  sample.reading.sigma,
                                  still_reading(sample.dot),
                                  at.excitation};
  reading_.verdict = follower_.observe(seen_there);
  sample.used = reading_.verdict == GapVerdict::used;
  if (sample.used) ++following_.used;
}

/// What a spot that has not moved in the picture would read on the surface as it is now.
double ContinuousGapController::still_reading(const vision::DotMeasurement& dot) {
  GapReading still;
  if (still_dot_ && read_gap(machine_, surface_, *still_dot_, still)) return still.gap;
  still_dot_ = dot;
  return std::nan("");
}

bool ContinuousGapController::shift(const PlannedPoint& point, Setpoint& ready) {
  if (active_) remember(point);
  const bool complete = filter_.shift(point, active_ ? correction_ : 0, ready);
  if (active_) {
    if (!filter_.reachable()) raise(GapStop::unreachable, history_.latest(), port_.now());
    note_offset(point);
  }
  return complete;
}

/// The path counts the tip's travel and its turns, as a motion's own parameter does.
void ContinuousGapController::remember(const PlannedPoint& point) {
  Commanded next;
  next.time = point.setpoint.time;
  next.X_WT = point.X_WT;
  next.filament = point.setpoint.filament;
  next.line = point.setpoint.line;
  if (!history_.empty()) {
    const Commanded& last = history_.latest();
    const double travelled = std::max((next.X_WT.translation() - last.X_WT.translation()).norm(),
                                      kTurnRadius * angle_between(next.X_WT.linear(), last.X_WT.linear()));
    next.path = last.path + travelled;
    next.printing = next.filament > last.filament && travelled > 0;
    if (!next.printing) follower_.pass(next.time - last.time, travelled);
  }
  const bool follow = next.printing && measurable_ && stop_ == GapStop::none;
  const GapFollower::Correction decided = follower_.advance(machine_.cycle_time, next.path, follow);
  correction_ = next.correction = decided.value;
  next.excitation = decided.excitation;
  history_.push(next);
}

void ContinuousGapController::note_offset(const PlannedPoint& point) {
  const Vec3 offset_W = offset_W_ + correction_ * tool_axis(point.X_WT);
  if (!report_ || point.setpoint.time < reported_at_ + kReportEvery ||
      !((offset_W - reported_W_).norm() > kReportChange) || offsets_.size() == offsets_.capacity())
    return;
  offsets_.push_back({point.setpoint.time, point.setpoint.line, offset_W, true});
  reported_at_ = point.setpoint.time;
  reported_W_ = offset_W;
}

void ContinuousGapController::record() {
  for (const OffsetChange& change : offsets_) report_(change);
  offsets_.clear();
  if (!reading_.judged) return;
  reading_.judged = false;
  if (reading_.seen == GapStop::none && !reading_.sample.used) reading_.sample.why = why_unused();
  keep(std::move(reading_.sample));
}

void ContinuousGapController::raise(GapStop reason, const Commanded& at, double time) {
  if (stop_ != GapStop::none) return;
  stop_ = reason;
  stopped_ = at;
  stop_time_ = time;
}

ContinuousGapController::StopCause ContinuousGapController::stop_cause() const {
  StopCause cause{"", stopped_.line, stop_time_};
  if (stop_ == GapStop::unreachable)
    cause.why = fmt::format(
        "with {:+.3f} mm along the tool's axis {}", to_mm(stopped_.correction),
        filter_.violations().empty() ? "no axes reach it" : to_string(filter_.violations().front()));
  else if (stop_ != GapStop::none)
    cause.why = why_follower_stopped();
  return cause;
}

std::string ContinuousGapController::why_unused() const {
  const GapReading& reading = reading_.sample.reading;
  switch (reading_.verdict) {
    case GapVerdict::used:
      return "";
    case GapVerdict::not_yet:
      return "the first readings are gathered";
    case GapVerdict::repeated:
      return "the reading repeats to the last digit: the picture stands still";
    case GapVerdict::jump:
      break;
  }
  return fmt::format("the gap reads {:.3f} mm where {:.3f} mm were expected, 1 sigma {:.3f} mm",
                     to_mm(reading.gap), to_mm(reading_.expected), to_mm(reading.sigma));
}

std::string ContinuousGapController::why_follower_stopped() const {
  const GapFollowerOptions& limits = options_.following;
  const GapSample& sample = reading_.sample;
  if (stop_ == GapStop::uncertain) return too_uncertain(machine_.gap, safe_.sigma);
  if (stop_ == GapStop::too_close && sample.used)
    return fmt::format("the gap is {:.3f} mm, 1 sigma {:.3f} mm: less than {:.3f} mm may be left",
                       to_mm(follower_.gap(stopped_.correction)),
                       to_mm(std::hypot(follower_.sigma(), safe_.sigma)), to_mm(limits.floor));
  if (stop_ == GapStop::too_far && sample.used)
    return fmt::format("the surface lies {:.3f} mm off the programmed one, at most {:.3f} mm are followed",
                       to_mm(-follower_.wanted()), to_mm(limits.travel_max));
  if (follower_.prevented() > 0)
    return fmt::format(
        "{} of the last {} frames could not be used, and the others do not tell the dot from another spot",
        follower_.prevented(), FrameOutcomes::kFrames);
  if (stop_ == GapStop::no_progress && follower_.unanswered() > 0)
    return fmt::format(
        "the gap reads {:.3f} mm and has not followed the tool, which rose by {:.3f} mm: "
        "what shines may not be the dot",
        to_mm(sample.reading.gap), to_mm(follower_.unanswered()));
  if (stop_ == GapStop::no_progress && sample.used)
    return fmt::format(
        "the gap reads {:.3f} mm and has not followed the tool, which may come nearer by {:.3f} mm "
        "until it does: what shines may not be the dot",
        to_mm(sample.reading.gap), to_mm(limits.unproved_max));
  if (stop_ == GapStop::implausible && follower_.mixed() > 0)
    return fmt::format(
        "{} of the last {} readings do not fit the others: more than one spot shines; the last: {}",
        follower_.mixed(), GapFollower::kMixedReadings, why_unused());
  return fmt::format("{} frames in {:.2f} s could not be used; the last: {}", follower_.missed(),
                     stopped_.time - follower_.blind_since(),
                     reading_.seen == GapStop::none ? why_unused() : sample.why);
}

/// Every sample stays; of the pictures every other one goes whenever there are too many.
void ContinuousGapController::keep(GapSample sample) {
  auto& samples = following_.samples;
  const auto stride = static_cast<std::size_t>(picture_stride_);
  if (samples.size() % stride != 0) sample.frame.image.pixels = {};
  samples.push_back(std::move(sample));
  if (samples.size() < stride * kPicturesMax) return;
  picture_stride_ *= 2;
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (i % (2 * stride) != 0) samples[i].frame.image.pixels = {};
}

}  // namespace understudy::control
