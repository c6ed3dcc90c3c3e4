#include "drivers/hal/hal_feed.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace understudy::drivers {

using machine::Fault;
using machine::Status;

namespace {

/// Slower than this the axes count as resting, as on the loopback port.
constexpr double kRest = 1e-6;  // [m/s or rad/s]

/// The clock of the twin, so that a controller that reads it plans the same setpoints on both.
constexpr double kTick = 0.5e-3;  // [s]

constexpr int kPauses = 4;            // share of the lead: what rests starts to move that much later
constexpr int kRestBeforeReset = 20;  // rows at rest before the latch is closed: the following error is over
constexpr int kSettling = 2000;       // samples in which a drive must come to its command at rest
constexpr double kInPosition = 1;     // [steps]
constexpr int kStays = 10;            // samples in position before an axis counts as there
// A step generator is at the command of a period in the middle of the next, and is read before it.
constexpr double kDriveDelay = 1.5;  // [servo periods]

Fault fault_of(const HalSample& sample, std::string& why) {
  if (!sample.stop_released) {
    why = "the chain of emergency stops is open (emergency-stop-ok)";
    return Fault::emergency_stop;
  }
  if (sample.limit) {
    why = "a limit switch is struck";
    return Fault::limit_switch;
  }
  if (sample.starved) {
    why = "HAL's watchdog has seen no setpoints: this process was too late";
    return Fault::underrun;
  }
  if (!sample.following) {
    why = "a drive does not follow its command";
    return Fault::following_error;
  }
  why = "HAL has switched the machine off (software-stop, or the latch was opened)";
  return Fault::drive;
}

}  // namespace

HalFeed::HalFeed(const HalSettings& settings, const HalFeedOptions& options, const HalSample& sample)
    : settings_(settings),
      options_(options),
      queue_(make_queue(sample.position, 0)),
      told_(static_cast<std::size_t>(options.lead) + 8),
      sample_(sample),
      tick_(kTick),
      ticks_per_row_(static_cast<int>(std::lround(settings.cycle / kTick))),
      sent_(options.first_number - 1),
      seen_(sent_),
      last_timed_(sent_),
      last_moving_(sent_),
      on_(sample.on),
      drives_(sample.drives) {
  if (ticks_per_row_ < 1 || std::abs(ticks_per_row_ * kTick - settings.cycle) > 1e-9) {
    tick_ = settings.cycle;
    ticks_per_row_ = 1;
  }
  for (Told& t : told_) t.position = sample.position;
}

machine::SetpointQueue HalFeed::make_queue(const machine::AxisVector& at, double now) const {
  machine::SetpointQueueOptions options;
  options.capacity = options_.capacity;
  options.ranges = options_.ranges;
  options.rest_velocity.fill(kRest);
  return {options, at, now};
}

bool HalFeed::at_rest() const {
  for (std::size_t i = 0; i < settings_.machine_axes; ++i)
    if (std::abs(queue_.target().velocity[i]) > kRest) return false;
  return true;
}

void HalFeed::tick() {
  const double next = static_cast<double>(++ticks_) * tick_;
  bool dry = false;
  while (!dry && queue_.execute_next(next) != nullptr) dry = queue_.ran_dry();
  queue_.advance_to(next);
  queue_.pass(tick_, next);
  last_timed_ = sent_ + 1;
  if (dry) raise(Fault::underrun, "the queue of setpoints ran dry while the machine moved");
}

/// Time to the next row, as far as somebody waits for it; half a tick of slack, as the twin's clock has.
bool HalFeed::advance() {
  while (fault_ == Fault::none && now() < goal_ - tick_ / 2) {
    tick();
    if (ticks_ % ticks_per_row_ == 0) return true;
  }
  return false;
}

HalRow HalFeed::tell(bool reset) {
  const machine::SetpointQueue::Target& target = queue_.target();
  HalRow row;
  row.position = target.position;
  row.filament = target.filament;
  row.number = ++sent_;
  row.reset = reset;
  row.outputs = outputs_;
  if (told(sent_ - 1).position != row.position) last_moving_ = sent_;
  told(sent_) = {now(), executed_before_ + queue_.executed(), !at_rest(), row.position};
  ++rows_;
  return row;
}

std::optional<HalRow> HalFeed::next_row() {
  const int under_way = sent_ - seen_;
  if (final_ || under_way >= options_.lead) return std::nullopt;
  if (switching_on_) {
    ++pauses_;
    return tell(++switching_pauses_ > kRestBeforeReset);
  }
  if (!on_) return std::nullopt;
  if (advance()) return tell(true);
  if (!at_rest() || under_way >= options_.lead / kPauses) return std::nullopt;
  ++pauses_;
  return tell(true);
}

void HalFeed::count_underruns(const HalSample& sample) {
  const int more = sample.underruns - sample_.underruns;
  if (!on_ || more <= 0) return;
  underruns_ += static_cast<std::uint64_t>(more);
  if (told(seen_).moving)
    raise(Fault::underrun,
          "HAL had no setpoint while the machine moved: the controller was later than the lead");
}

void HalFeed::take(const HalSample& sample) {
  const bool ours = sample.number - options_.first_number >= 0 && sample.number <= sent_;
  if (ours) seen_ = std::max(seen_, sample.number);
  if (on_ && !sample.on) machine_stopped(sample);
  count_underruns(sample);
  on_ = sample.on;
  drives_ = sample.drives;
  if (on_ && switching_on_) switching_on_ = false;
  sample_ = sample;
  if (!ours) return;
  if (on_) executed_ = std::max(executed_, told(seen_).executed);
  check_in_position();
}

void HalFeed::check_in_position() {
  const Told& row = told(seen_);
  bool near = true;
  for (std::size_t i = 0; i < settings_.machine_axes; ++i) {
    const HalAxis& axis = settings_.axes[i];
    const double off = std::abs(axis.units(sample_.position[i] - row.position[i]));
    if (off > kInPosition / axis.scale) near = false;
  }
  samples_in_position_ = near ? samples_in_position_ + 1 : 0;
  samples_out_of_position_ = near || row.moving || !on_ ? 0 : samples_out_of_position_ + 1;
  if (samples_out_of_position_ > kSettling)
    raise(Fault::following_error,
          fmt::format("a drive does not come to its command within {} periods at rest", kSettling));
}

void HalFeed::machine_stopped(const HalSample& sample) {
  std::string why;
  const Fault fault = fault_of(sample, why);
  raise(fault, why);
}

void HalFeed::raise(Fault fault, const std::string& why) {
  if (fault_ != Fault::none) return;
  fault_ = fault;
  fault_text_ = why;
  queue_.clear(now());
  queue_.advance_to(now());  // the target's velocity too
  goal_ = 0;
}

void HalFeed::lose(const std::string& why) {
  lost_ = final_ = true;
  on_ = drives_ = switching_on_ = false;
  raise(Fault::drive, why);
}

void HalFeed::stop_for_good(const std::string& why) {
  final_ = true;
  fault_ = Fault::none;  // whatever stood: this is what the operator wants to read
  raise(Fault::emergency_stop, why);
}

void HalFeed::switch_on() {
  // From where the machine has come to rest; what was under way when it stopped was never executed.
  accepted_before_ += queue_.accepted();
  executed_before_ = executed_;
  queue_ = make_queue(sample_.position, now());
  queue_.advance_to(now());
  switching_on_ = true;
  switching_pauses_ = 0;
}

void HalFeed::give_up_switching_on() {
  switching_on_ = false;
  std::string why;
  const Fault fault = fault_of(sample_, why);
  fault_ = Fault::none;
  raise(fault, "the machine does not switch on: " + why);
}

machine::AxisState HalFeed::state() const {
  machine::AxisState s;
  s.time = now();
  const Told& row = told(seen_);
  s.sampled_at = rows_ == 0 ? 0 : row.moving ? row.time - kDriveDelay * settings_.cycle : row.time;
  s.position = sample_.position;
  s.accepted = accepted_before_ + queue_.accepted();
  s.executed = executed_;
  s.free_slots = queue_.free_slots();
  s.moving = fault_ == Fault::none && (queue_.moving() || seen_ < last_moving_);
  s.fault = fault_;
  return s;
}

bool HalFeed::read_load(machine::LoadReading& reading) const {
  if (!settings_.load_encoders) return false;
  reading = {state().sampled_at, sample_.load};
  return true;
}

Status HalFeed::submit(std::span<const machine::Setpoint> setpoints, double deadline) {
  if (fault_ != Fault::none) return Status::faulted;
  if (now() > deadline) return Status::deadline_exceeded;
  return queue_.submit(setpoints, now());
}

Status HalFeed::set_outputs(const machine::Outputs& outputs, double deadline) {
  if (fault_ != Fault::none && !outputs.off()) return Status::faulted;
  if (now() > deadline) return Status::deadline_exceeded;
  outputs_ = outputs;
  return Status::ok;
}

Status HalFeed::urgent(machine::UrgentCommand command) {
  switch (command) {
    case machine::UrgentCommand::hold:
      queue_.hold();
      return Status::ok;
    case machine::UrgentCommand::resume:
      queue_.resume();
      return Status::ok;
    case machine::UrgentCommand::stop:
      queue_.stop(now());
      return Status::ok;
    case machine::UrgentCommand::clear_fault:
      if (final_ || (fault_ != Fault::none && !on_)) return Status::faulted;
      fault_ = Fault::none;
      fault_text_.clear();
      return Status::ok;
  }
  return Status::rejected;
}

bool HalFeed::caught_up() const { return seen_ >= last_timed_ && samples_in_position_ >= kStays; }

bool HalFeed::arrived(double time) const {
  if (lost_) return true;
  if (fault_ != Fault::none) return on_ ? caught_up() : !drives_ && seen_ == sent_;
  if (now() < time - tick_ / 2) return false;
  return !at_rest() || caught_up();
}

}  // namespace understudy::drivers
