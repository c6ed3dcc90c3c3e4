#include "drivers/hal/hal_process.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/wait.h>

#include <array>
#include <cstdlib>
#include <sstream>
#include <thread>

#include <fmt/format.h>

#include "core/error.h"

namespace understudy::drivers {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr milliseconds kLoadPatience{10000};   // for one attempt; a second is usual
constexpr milliseconds kStartPatience{15000};  // for the last attempt to begin
// halrun unloads all components, and then gives its realtime process five seconds to end.
constexpr milliseconds kEndPatience{10000};

/// What HAL says of a line that it does not take, "pins.hal:9: Pin 'x' does not exist"; empty: of none.
std::string wrong_line(const std::string& log) {
  const std::size_t place = log.find(".hal:");
  if (place == std::string::npos) return {};
  const std::size_t begin = log.rfind(';', place);
  return log.substr(begin == std::string::npos ? 0 : begin + 1, log.find(';', place) - begin - 1);
}

/// For the operator's shell: ends a HAL that a run of this program has left behind.
std::string ending_command() {
  return fmt::format("`{}RTAPI_FIFO_PATH={} halrun -U`",
                     ::geteuid() == 0 ? fmt::format("RTAPI_UID={} ", std::getenv("RTAPI_UID")) : "",
                     std::getenv("RTAPI_FIFO_PATH"));
}

}  // namespace

/// rtapi_app refuses to stay root, and puts its socket into $HOME where nothing else is said.
void set_hal_environment() {
  if (::geteuid() == 0) ::setenv("RTAPI_UID", "65534", 0);
  ::setenv("RTAPI_FIFO_PATH", fmt::format("/tmp/understudy-rtapi-{}", ::getuid()).c_str(), 0);
}

std::string running_hal() {
  std::istringstream lines(answer_of({"halcmd", "-s", "show", "sig"}, kAnswerPatience));
  for (std::string word; lines >> word;)
    if (word.starts_with(kHalSignal)) return word;
  return {};
}

HalProcess::HalProcess(const std::string& folder, const std::string& configuration, double linger)
    : folder_(folder), linger_(linger) {
  set_hal_environment();
  if (const std::string running = running_hal(); !running.empty())
    throw MachineError(fmt::format(
        "HAL runs already, with the configuration {}: print on it by hal://, or end it where it was started, "
        "or by {}",
        running, ending_command()));
  try {
    start(configuration);
  } catch (...) {
    end();
    throw;
  }
}

void HalProcess::start(const std::string& configuration) {
  const auto until = Clock::now() + kStartPatience;
  for (;;) {
    launch();
    const Start start = loading(configuration);
    if (start == Start::loaded) return;
    if (!is_transient(start) || Clock::now() > until) refuse(start);
    end();
    std::this_thread::sleep_for(milliseconds(200));
  }
}

void HalProcess::launch() {
  log_ = Descriptor(::memfd_create("understudy-hal", MFD_CLOEXEC));
  ChildStreams streams;
  streams.input = true;
  streams.log = log_.get();
  halrun_ = std::make_unique<ChildProcess>(std::vector<std::string>{"halrun", "-I", "-f", "machine.hal"},
                                           folder_, streams, false);
  start_guard();
}

/// HAL ends when nobody holds its standard input open. The guard does for as long as the watchdog needs.
void HalProcess::start_guard() {
  std::array<int, 2> life{};
  if (::pipe2(life.data(), O_CLOEXEC) != 0) throw MachineError("no pipe could be made to HAL's guard");
  const Descriptor seen(life[0]);
  life_ = Descriptor(life[1]);
  ChildStreams guarding;
  guarding.log = halrun_->input.get();  // held open, never written to: its programs print nothing
  guarding.inherited = seen.get();
  guard_ = std::make_unique<ChildProcess>(
      std::vector<std::string>{"sh", "-c", fmt::format("cat <&3 >/dev/null 2>&1; sleep {:.3f}", linger_)}, "",
      guarding, false);
}

HalProcess::Start HalProcess::loading(const std::string& configuration) {
  const auto until = Clock::now() + kLoadPatience;
  while (running_hal() != configuration) {
    if (!wrong_line(log_text()).empty()) return Start::refused;
    if (!halrun_->running()) return Start::ended;
    if (Clock::now() > until) return Start::stuck;
    std::this_thread::sleep_for(milliseconds(20));
  }
  return Start::loaded;
}

bool HalProcess::is_transient(Start start) const {
  const std::string said = log_text();
  return start == Start::stuck || said.find("Realtime already running") != std::string::npos ||
         said.find("exited without becoming ready") != std::string::npos;
}

void HalProcess::refuse(Start start) const {
  const std::string said = log_text();
  if (start == Start::stuck) throw MachineError("HAL does not start: " + said);
  if (start == Start::refused)
    throw InputError(fmt::format("hal://{}: HAL refuses {}", folder_, wrong_line(said)));
  const int status = WEXITSTATUS(halrun_->status());
  if (status == 127) throw MachineError("halrun is not installed: apt-get install linuxcnc-uspace");
  if (said.find("Realtime already running") != std::string::npos)
    throw MachineError(
        "HAL runs already, with a configuration of another program: end that program, as LinuxCNC, or HAL "
        "alone by `halrun -U`");
  throw MachineError(fmt::format("halrun ended with status {}: {}", status, said));
}

void HalProcess::end() {
  if (guard_) guard_->end(milliseconds(0));
  if (!halrun_ || halrun_->end(kEndPatience)) return;
  // halrun was killed before its realtime process had ended, which would keep the next HAL from starting.
  static_cast<void>(answer_of({"halrun", "-U"}, kEndPatience));
}

std::string HalProcess::log_text() const {
  std::string text(4000, '\0');
  const ssize_t n = ::pread(log_.get(), text.data(), text.size(), 0);
  text.resize(n > 0 ? static_cast<std::size_t>(n) : 0);
  for (char& c : text)
    if (c == '\n') c = ';';
  return text.empty() ? "it said nothing" : text;
}

}  // namespace understudy::drivers
