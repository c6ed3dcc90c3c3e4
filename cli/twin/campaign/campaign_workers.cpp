#include "cli/twin/campaign/campaign_workers.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <deque>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <system_error>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/twin/own_process.h"
#include "core/error.h"
#include "core/file/descriptor.h"
#include "core/interrupt.h"
#include "core/process/pipe.h"
#include "core/thread_limit.h"
#include "renderer/drawing_threads.h"
#include "renderer/laser_view.h"

namespace understudy::cli {
namespace {

constexpr std::size_t kAhead = 2;  // runs that a worker has: the next one waits for it, not it for us
constexpr int kKillsMax = 20;      // of one run, from outside
constexpr int kCrashesMax = 2;     // of one run, by itself
constexpr int kPollMilliseconds = 100;

/// Signals that a process gets for what it does itself.
bool is_crash(int signal) {
  return signal == SIGSEGV || signal == SIGBUS || signal == SIGILL || signal == SIGFPE || signal == SIGABRT;
}

class Worker {
 public:
  explicit Worker(const std::vector<std::string>& words) {
    Pipe in, out;
    pid_ = start_own_process(words, in.read.get(), out.write.get());
    to_ = std::move(in.write);
    from_ = std::move(out.read);
  }
  ~Worker() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  bool wants_more() const { return runs_.size() < kAhead; }
  bool idle() const { return runs_.empty(); }
  const std::deque<std::uint64_t>& runs() const { return runs_; }
  int output() const { return from_.get(); }

  /// False: it has died.
  bool give(std::uint64_t run) {
    const std::string line = fmt::format("{}\n", run);
    runs_.push_back(run);
    return ::write(to_.get(), line.data(), line.size()) == static_cast<ssize_t>(line.size());
  }

  /// Runs that it has done since; nothing when its output has ended.
  std::optional<std::vector<std::uint64_t>> take() {
    std::array<char, 4096> bytes;
    const ssize_t got = ::read(from_.get(), bytes.data(), bytes.size());
    if (got < 0 && errno == EINTR) return std::vector<std::uint64_t>{};
    if (got <= 0) return std::nullopt;
    text_.append(bytes.data(), static_cast<std::size_t>(got));
    std::vector<std::uint64_t> done;
    for (std::size_t end; (end = text_.find('\n')) != std::string::npos; text_.erase(0, end + 1)) {
      std::uint64_t run = 0;
      const std::size_t begin = std::min(end, std::size_t{5});  // "done "
      std::from_chars(text_.data() + begin, text_.data() + end, run);
      done.push_back(run);
      std::erase(runs_, run);
    }
    return done;
  }

  /// Waits for its end; the status as waitpid() tells it.
  int ended() {
    to_.close();
    int status = 0;
    while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    pid_ = 0;
    return status;
  }
  void no_more() { to_.close(); }

 private:
  pid_t pid_ = 0;
  Descriptor to_, from_;
  std::string text_;
  std::deque<std::uint64_t> runs_;  // given and not done, in their order
};

/// The work of all workers.
class Pool {
 public:
  Pool(const std::vector<std::string>& words, CampaignFolder& folder, const studies::RunPlan& plan,
       const studies::RunInputs& inputs, const Progress& progress)
      : words_(words), folder_(folder), plan_(plan), inputs_(inputs), progress_(progress) {}

  void run(const std::vector<std::uint64_t>& runs, std::size_t count) {
    waiting_.assign(runs.begin(), runs.end());
    all_ = runs.size();
    for (std::size_t i = 0; i < std::min(count, runs.size()); ++i) workers_.push_back(start());
    while (done_ < all_) {
      stop_if_interrupted();
      feed();
      listen();
    }
    for (auto& worker : workers_) worker->no_more();
    for (auto& worker : workers_) check_end(worker->ended());
  }

 private:
  std::unique_ptr<Worker> start() {
    std::vector<std::string> words = words_;
    words.insert(words.end(), {"--worker", fmt::format("local-{}-{}", ::getpid(), started_++)});
    return std::make_unique<Worker>(words);
  }

  void feed() {
    for (auto& worker : workers_)
      while (worker->wants_more() && !waiting_.empty()) {
        const std::uint64_t run = waiting_.front();
        waiting_.pop_front();
        if (!worker->give(run)) break;  // its end is seen when it is listened to
      }
  }

  void listen() {
    std::vector<pollfd> outputs;
    for (const auto& worker : workers_) outputs.push_back({worker->output(), POLLIN, 0});
    if (::poll(outputs.data(), outputs.size(), kPollMilliseconds) < 0 && errno != EINTR)
      throw MachineError("cannot listen to workers: " + std::generic_category().message(errno));
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      if ((outputs[i].revents & (POLLIN | POLLHUP | POLLERR)) == 0) continue;
      const auto done = workers_[i]->take();
      if (!done) {
        replace(workers_[i]);
        continue;
      }
      done_ += done->size();
      if (progress_ && !done->empty())
        progress_(static_cast<double>(done_) / static_cast<double>(all_),
                  fmt::format("run {} of {}", done_, all_));
    }
  }

  void replace(std::unique_ptr<Worker>& worker) {
    const int status = worker->ended();
    check_end(status);
    const std::deque<std::uint64_t> lost = worker->runs();
    if (!lost.empty()) {
      blame(lost.front(), WTERMSIG(status));
      for (auto run = lost.rbegin(); run != lost.rend(); ++run)
        if (!crashed_.contains(*run)) waiting_.push_front(*run);
    }
    worker = start();
  }

  /// A worker that ends by itself has told why.
  void check_end(int status) {
    stop_if_interrupted();
    if (!WIFEXITED(status) || WEXITSTATUS(status) == kGood) return;
    if (WEXITSTATUS(status) == kBadInput) throw InputError("a worker could not go on: see above");
    throw MachineError("a worker could not go on: see above");
  }

  void blame(std::uint64_t run, int signal) {
    if (!is_crash(signal)) {
      if (++kills_[run] > kKillsMax)
        throw MachineError(
            fmt::format("run {} was killed {} times by signal {}: is there too little memory? "
                        "Fewer --workers need less",
                        run, kills_[run], signal));
      return;
    }
    if (++crashes_[run] < kCrashesMax) return;
    crashed_[run] = true;
    ++done_;
    const studies::CampaignRun is = plan_.run(run);
    studies::RunRow row;
    row.index = run;
    row.seed = is.seed;
    row.values = is.values;
    row.scenario = inputs_.scenario_name(is.scenario);
    row.end = studies::RunEnd::crashed;
    row.error = fmt::format("the process ended by signal {}", signal);
    row.command = inputs_.command(run);
    studies::ResultStore(folder_.part(fmt::format("crashed-{}", ::getpid())), folder_.header()).add(row);
  }

  const std::vector<std::string>& words_;
  CampaignFolder& folder_;
  const studies::RunPlan& plan_;
  const studies::RunInputs& inputs_;
  const Progress& progress_;
  std::vector<std::unique_ptr<Worker>> workers_;
  std::deque<std::uint64_t> waiting_;
  std::map<std::uint64_t, int> kills_, crashes_;
  std::map<std::uint64_t, bool> crashed_;
  std::size_t all_ = 0, done_ = 0;
  int started_ = 0;
};

}  // namespace

void LocalWorkers::run(const std::vector<std::uint64_t>& runs, const studies::RunPlan& plan,
                       const studies::RunInputs& inputs, const Progress& progress) {
  ::signal(SIGPIPE, SIG_IGN);  // a worker that died is seen by its output
  Pool(words_, folder_, plan, inputs, progress).run(runs, static_cast<std::size_t>(count_));
}

int run_campaign_worker(const CampaignFolder& folder, const std::string& part, const studies::RunPlan& plan,
                        studies::RunInputs& inputs) {
  end_with_parent();
  // As many workers as processors are there: more threads would wait for each other.
  limit_threads(1);
  renderer::draw_on_calling_thread();
  renderer::keep_laser_views();
  folder.check();
  studies::ResultStore store(folder.part(part), folder.header());
  for (std::uint64_t index = 0; std::cin >> index;) {
    stop_if_interrupted();
    store.add(inputs.rehearse(plan.run(index)));
    std::fputs(fmt::format("done {}\n", index).c_str(), stdout);
    if (std::fflush(stdout) != 0) return kGood;  // nobody listens any more
  }
  return kGood;
}

}  // namespace understudy::cli
