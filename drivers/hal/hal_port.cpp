#include "drivers/hal/hal_port.h"

#include <charconv>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <csignal>
#include <future>
#include <limits>
#include <mutex>
#include <thread>

#include <fmt/format.h>

#include "core/error.h"
#include "drivers/hal/hal_feed.h"
#include "drivers/hal/hal_session.h"

namespace understudy::drivers {

using machine::Fault;
using machine::Status;
using machine::UrgentCommand;

namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kExchange{2};      // between two looks at what is due
constexpr milliseconds kSilence{3000};    // without a sample: HAL stands still
constexpr milliseconds kPatience{10000};  // beyond what a wait must take
constexpr milliseconds kSwitchOn{3000};   // for the latch to close

milliseconds real(double seconds) { return milliseconds(static_cast<long>(std::ceil(seconds * 1e3))); }

HalFeedOptions feed_options(const machine::MachineDescription& machine, const HalSettings& settings,
                            const HalPortOptions& options) {
  HalFeedOptions feed;
  const auto mechanism = machine.make_mechanism();
  for (int i = 0; i < mechanism->axis_count(); ++i) feed.ranges.push_back(mechanism->axis_range(i));
  feed.lead = static_cast<int>(std::lround(options.lead / settings.cycle));
  // No number of a run before this one is under way any more: milliseconds since the system started.
  const auto since = std::chrono::duration_cast<milliseconds>(Clock::now().time_since_epoch()).count();
  feed.first_number = static_cast<std::int32_t>(since % 1'000'000'000) + 1;
  return feed;
}

}  // namespace

/// The feed, shared between the caller and the one thread that speaks to HAL.
class HalPort::Link {
 public:
  Link(const machine::MachineDescription& machine, const HalPortOptions& options)
      : settings_(hal_settings(machine)), lead_(options.lead) {
    std::promise<void> opened;
    auto answer = opened.get_future();
    const HalFeedOptions feed = feed_options(machine, settings_, options);
    thread_ = std::thread([this, feed, folder = options.folder, &opened] { run(feed, folder, opened); });
    try {
      answer.get();
    } catch (...) {
      thread_.join();
      throw;
    }
    std::unique_lock lock(mutex_);
    static_cast<void>(switch_on(lock));
  }
  ~Link() {
    {
      std::unique_lock lock(mutex_);
      if (feed_->fault() == Fault::none && !feed_->at_rest()) {
        static_cast<void>(feed_->urgent(UrgentCommand::stop));
        static_cast<void>(wait_until(lock, feed_->now() + 2 * machine::kBrakingTime));
      }
      ending_ = true;
    }
    thread_.join();
  }
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  const HalSettings& settings() const { return settings_; }
  /// The feed for one call, locked against the thread.
  template <typename Call>
  auto with(Call&& call) const {
    const std::lock_guard lock(mutex_);
    return call(*feed_);
  }
  Status wait_until(double time) {
    std::unique_lock lock(mutex_);
    return wait_until(lock, time);
  }
  Status clear_fault() {
    std::unique_lock lock(mutex_);
    if (feed_->fault() == Fault::none || feed_->on()) return feed_->urgent(UrgentCommand::clear_fault);
    return feed_->final() ? Status::faulted : switch_on(lock);
  }

 private:
  void run(const HalFeedOptions& options, const std::string& folder, std::promise<void>& opened) {
    // Signals are the caller's; a program of HAL's that has gone is an answer of write(), no signal.
    sigset_t all;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_BLOCK, &all, nullptr);
    prefer_this_thread();
    std::unique_ptr<HalSession> session;
    try {
      session = std::make_unique<HalSession>(settings_, folder);
      std::vector<HalSample> samples;
      while (samples.empty())
        if (!session->exchange(samples, kExchange)) throw MachineError("HAL has ended");
      const std::lock_guard lock(mutex_);
      feed_.emplace(settings_, options, samples.back());
    } catch (...) {
      opened.set_exception(std::current_exception());
      return;
    }
    opened.set_value();
    speak(*session);
  }

  void speak(HalSession& session) {
    std::vector<HalSample> samples;
    auto last_sample = Clock::now();
    for (;;) {
      {
        const std::lock_guard lock(mutex_);
        if (ending_) return;
        while (const auto row = feed_->next_row()) session.send(*row);
      }
      samples.clear();
      const bool there = session.exchange(samples, kExchange);
      if (!samples.empty()) last_sample = Clock::now();
      const std::lock_guard lock(mutex_);
      for (const HalSample& sample : samples) feed_->take(sample);
      if (!there) feed_->lose("HAL has ended, or its streamer or sampler has");
      if (Clock::now() - last_sample > kSilence) feed_->lose("HAL stands still: no sample for 3 s");
      changed_.notify_all();
      if (feed_->lost()) return;
    }
  }

  Status wait_until(std::unique_lock<std::mutex>& lock, double time) {
    HalFeed& feed = *feed_;
    if (feed.fault() != Fault::none) return Status::faulted;
    if (!(time > feed.now())) return Status::ok;
    const auto until = Clock::now() + real(time - feed.now() + lead_) + kPatience;
    feed.wait_for(time);
    if (!changed_.wait_until(lock, until, [&] { return feed.arrived(time); }))
      feed.raise(Fault::drive, "HAL takes no setpoints");
    feed.wait_for(0);
    return feed.fault() == Fault::none ? Status::ok : Status::faulted;
  }

  Status switch_on(std::unique_lock<std::mutex>& lock) {
    HalFeed& feed = *feed_;
    const auto patience = kSwitchOn + real(2 * lead_ + settings_.brake_time + settings_.options.watchdog);
    // What an earlier stop or run left under way is over first.
    if (!changed_.wait_until(lock, Clock::now() + patience,
                             [&] { return feed.may_switch_on() || feed.lost(); }))
      feed.raise(Fault::drive, "the drives do not switch off");
    if (!feed.may_switch_on()) return Status::faulted;
    feed.switch_on();
    const bool on =
        changed_.wait_until(lock, Clock::now() + patience, [&] { return feed.on() || feed.lost(); });
    if (feed.lost()) return Status::faulted;
    if (on) return feed.urgent(UrgentCommand::clear_fault);
    feed.give_up_switching_on();
    return Status::faulted;
  }

  const HalSettings settings_;
  const double lead_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  mutable std::optional<HalFeed> feed_;  ///< since the session is open
  bool ending_ = false;
  std::thread thread_;
};

HalPort::HalPort(const machine::MachineDescription& machine, const HalPortOptions& options)
    : link_(std::make_unique<Link>(machine, options)), options_(options) {}
HalPort::~HalPort() = default;

int HalPort::axis_count() const { return static_cast<int>(link_->settings().machine_axes); }
double HalPort::now() const {
  return link_->with([](HalFeed& feed) { return feed.now(); });
}
machine::AxisState HalPort::state() const {
  return link_->with([](HalFeed& feed) { return feed.state(); });
}
bool HalPort::read_load(machine::LoadReading& reading) const {
  return link_->with([&](HalFeed& feed) { return feed.read_load(reading); });
}
Status HalPort::submit(std::span<const machine::Setpoint> setpoints, double deadline) {
  return link_->with([&](HalFeed& feed) { return feed.submit(setpoints, deadline); });
}
Status HalPort::wait_until(double time) { return link_->wait_until(time); }
Status HalPort::urgent(UrgentCommand command) {
  if (command == UrgentCommand::clear_fault) return link_->clear_fault();
  return link_->with([&](HalFeed& feed) { return feed.urgent(command); });
}
Status HalPort::set_outputs(const machine::Outputs& outputs, double deadline) {
  return link_->with([&](HalFeed& feed) { return feed.set_outputs(outputs, deadline); });
}
std::string HalPort::fault_text() const {
  return link_->with([](HalFeed& feed) { return feed.fault_text(); });
}
HalCounts HalPort::counts() const {
  return link_->with([](HalFeed& feed) { return HalCounts{feed.rows(), feed.pauses(), feed.underruns()}; });
}

void HalPort::emergency_stop() {
  link_->with([](HalFeed& feed) { feed.stop_for_good("stopped by the operator"); });
  open_latch();
}

/// The machine is behind the port's clock while it moves: time passes until it has reached the exposure.
Status HalPort::capture(const Region& region, machine::Frame& frame, double deadline) {
  const double asked = now();
  if (asked + options_.frame_time > deadline) return Status::deadline_exceeded;
  if (!options_.frames) return Status::no_frame;
  const double exposed_at = asked + options_.frame_time / 2;
  if (const Status s = wait_until(exposed_at); s != Status::ok) return s;
  while (state().sampled_at < exposed_at) {
    if (now() > deadline) return Status::deadline_exceeded;
    if (const Status s = wait_until(now() + 5 * link_->settings().cycle); s != Status::ok) return s;
  }
  const machine::AxisState exposed = state();
  const double received_at = std::max(now(), exposed.sampled_at + options_.frame_time / 2);
  if (const Status s = wait_until(received_at); s != Status::ok) return s;
  Image image;
  if (!options_.frames(exposed, region, image)) return Status::no_frame;
  last_frame_.image = std::move(image);
  last_frame_.exposed_at = exposed.sampled_at;
  last_frame_.received_at = now();
  last_frame_.number = frames_delivered_++;
  frame = last_frame_;
  return Status::ok;
}

HalPortOptions hal_port_options(const std::string& uri) {
  constexpr std::string_view kScheme = "hal://", kLead = "lead_ms=";
  if (!uri.starts_with(kScheme)) throw InputError(fmt::format("{}: not hal://FOLDER or hal://", uri));
  HalPortOptions options;
  const std::size_t question = uri.find('?');
  options.folder =
      uri.substr(kScheme.size(), question == std::string::npos ? question : question - kScheme.size());
  if (question == std::string::npos) return options;
  const std::string_view option = std::string_view(uri).substr(question + 1);
  if (!option.starts_with(kLead))
    throw InputError(
        fmt::format("{}: unknown option '{}': lead_ms", uri, option.substr(0, option.find('='))));
  const std::string_view value = option.substr(kLead.size());
  double milliseconds = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), milliseconds);
  if (error != std::errc() || end != value.data() + value.size() ||
      !(milliseconds >= 20 && milliseconds <= 3000))
    throw InputError(fmt::format("{}: lead_ms is '{}', not a number from 20 to 3000", uri, value));
  options.lead = milliseconds * 1e-3;
  return options;
}

std::unique_ptr<machine::MachinePort> open_hal_port(const std::string& uri,
                                                    const machine::MachineDescription& machine) {
  return std::make_unique<HalPort>(machine, hal_port_options(uri));
}

}  // namespace understudy::drivers
