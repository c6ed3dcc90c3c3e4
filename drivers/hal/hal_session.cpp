#include "drivers/hal/hal_session.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include <fmt/format.h>

#include "core/error.h"
#include "core/file/is_file.h"

namespace understudy::drivers {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

// One HAL runs on a computer, whoever started it.
constexpr const char* kLock = "/tmp/understudy-hal.lock";
constexpr milliseconds kStartPatience{15000};
constexpr int kPipeBytes = 1 << 20;

std::string signal_name(const HalSettings& settings) { return kHalSignal + settings.fingerprint; }

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

void check_folder(const HalSettings& settings, const std::string& folder) {
  const auto file = std::filesystem::path(folder) / "machine.hal";
  if (!is_file(file))
    throw InputError(
        fmt::format("hal://{}: no machine.hal in it; write it by: understudy export hal --machine {} -o {}",
                    folder, settings.machine, folder));
  if (text_of(file).find("newsig " + signal_name(settings) + " ") == std::string::npos)
    throw InputError(fmt::format(
        "{}: written for another machine, calibration or version ({} is not in it); write it again by: "
        "understudy export hal --machine {} -o {}",
        file.string(), signal_name(settings), settings.machine, folder));
}

}  // namespace

HalSession::HalSession(const HalSettings& settings, const std::string& folder) : settings_(settings) {
  try {
    open(folder);
  } catch (...) {
    close();
    throw;
  }
}

void HalSession::open(const std::string& folder) {
  if (!folder.empty()) check_folder(settings_, folder);
  set_hal_environment();
  hold_lock();
  if (folder.empty())
    check_running();
  else
    hal_ = std::make_unique<HalProcess>(folder, signal_name(settings_),
                                        1 + settings_.options.watchdog + settings_.brake_time);
  open_streams();
  skip_old_samples();
}

void HalSession::close() {
  // No row any more: the watchdog opens the latch, the machine brakes and its drives go off.
  if (streamer_) streamer_->end(milliseconds(500));
  if (sampler_) {
    sampler_->output.close();
    sampler_->end(milliseconds(0));
  }
  if (!hal_) return;
  std::this_thread::sleep_for(
      std::chrono::duration<double>(settings_.options.watchdog + settings_.brake_time));
  hal_->end();
}

void HalSession::hold_lock() {
  lock_ = Descriptor(::open(kLock, O_RDWR | O_CREAT | O_CLOEXEC, 0666));
  static_cast<void>(::fchmod(lock_.get(), 0666));
  if (!lock_.is_open() || ::flock(lock_.get(), LOCK_EX | LOCK_NB) != 0)
    throw MachineError(
        fmt::format("HAL is held by another run of this program ({}): one may print at a time", kLock));
}

void HalSession::check_running() const {
  const std::string running = running_hal();
  if (running.empty())
    throw MachineError(fmt::format(
        "hal://: HAL does not run with a configuration of this program; start it by "
        "`halrun -I -f machine.hal` in a folder of `understudy export hal --machine {}`, or name the folder: "
        "hal://FOLDER",
        settings_.machine));
  if (running != signal_name(settings_))
    throw InputError(
        fmt::format("hal://: HAL runs with the configuration {} of another machine, calibration or "
                    "version; {} has {}",
                    running, settings_.machine, signal_name(settings_)));
  for (std::size_t i = 0; i < settings_.axes.size(); ++i) {
    const std::string text =
        answer_of({"halcmd", "-s", "getp", fmt::format("stepgen.{}.position-scale", i)}, kAnswerPatience);
    const double scale = std::atof(text.c_str());
    if (!text.empty() && std::abs(scale - settings_.axes[i].scale) > 1e-6 * std::abs(scale) &&
        !settings_.axes[i].assumed)
      throw InputError(fmt::format("hal://: axis {} has {} steps per unit in HAL, {:.6g} in the machine file",
                                   settings_.axes[i].name, scale, settings_.axes[i].scale));
  }
}

void HalSession::open_streams() {
  static_cast<void>(answer_of({"halcmd", "sets", "software-stop", "0"}, kAnswerPatience));
  ChildStreams in, out;
  in.input = true;
  out.output = true;
  streamer_ =
      std::make_unique<ChildProcess>(std::vector<std::string>{"halstreamer", "-c", "0"}, "", in, true);
  // Line by line: the reader of a pipe would else wait until 4096 bytes have come together.
  sampler_ = std::make_unique<ChildProcess>(
      std::vector<std::string>{"stdbuf", "-oL", "halsampler", "-c", "0"}, "", out, true);
  static_cast<void>(::fcntl(streamer_->input.get(), F_SETPIPE_SZ, kPipeBytes));
}

/// Of a HAL that ran before us the FIFO is full of the past.
void HalSession::skip_old_samples() {
  const auto until = Clock::now() + kStartPatience;
  std::vector<HalSample> samples;
  bool any = false;
  do {
    if (Clock::now() > until) throw MachineError("HAL gives no samples: its threads do not run");
    samples.clear();
    const auto began = Clock::now();
    while (Clock::now() - began < milliseconds(40))
      if (!exchange(samples, milliseconds(10)))
        throw MachineError(
            "HAL's streamer or sampler refuses us: another program holds it, or HAL has ended");
    any = any || !samples.empty();
  } while (!any || samples.size() > 200);  // five times what 40 ms bring
}

bool HalSession::exchange(std::vector<HalSample>& samples, milliseconds time) {
  std::size_t done = 0;
  while (done < outgoing_.size()) {
    const ssize_t n = ::write(streamer_->input.get(), outgoing_.data() + done, outgoing_.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0 && errno != EAGAIN) return false;
    if (n < 0) break;
    done += static_cast<std::size_t>(n);
  }
  outgoing_.erase(0, done);
  pollfd ready{sampler_->output.get(), POLLIN, 0};
  if (::poll(&ready, 1, static_cast<int>(time.count())) <= 0)
    return streamer_->running() && sampler_->running();
  std::array<char, 65536> part{};
  const ssize_t n = ::read(sampler_->output.get(), part.data(), part.size());
  if (n == 0) return false;
  if (n > 0) incoming_.append(part.data(), static_cast<std::size_t>(n));
  std::size_t begin = 0;
  for (std::size_t end; (end = incoming_.find('\n', begin)) != std::string::npos; begin = end + 1) {
    HalSample sample;
    if (parse(std::string_view(incoming_).substr(begin, end - begin), settings_, sample))
      samples.push_back(sample);
  }
  incoming_.erase(0, begin);
  return true;
}

void open_latch() { static_cast<void>(answer_of({"halcmd", "sets", "software-stop", "1"}, kAnswerPatience)); }

}  // namespace understudy::drivers
