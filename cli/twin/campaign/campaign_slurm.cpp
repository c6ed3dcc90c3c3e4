#include "cli/twin/campaign/campaign_slurm.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <system_error>
#include <thread>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/command.h"
#include "cli/progress.h"
#include "cli/twin/campaign/slurm_client.h"
#include "core/error.h"
#include "core/file/output_file.h"
#include "core/file/read_file.h"
#include "core/interrupt.h"

namespace understudy::cli {
namespace fs = std::filesystem;
namespace {

constexpr int kTasksMax = 1000;  // MaxArraySize is 1001 unless a site says otherwise
constexpr int kTasksAProcessor = 4;
constexpr std::chrono::seconds kWatch{2};
constexpr double kMega = 1e6;

std::string script_of(const std::vector<std::string>& words, const std::string& last) {
  std::string script = "#!/bin/sh\nexec";
  for (const std::string& word : words) script += " " + shell_quoted(word);
  return script + " " + last + "\n";
}

/// Of sbatch, which puts a number in place of each %a, and % in place of %%.
std::string output_option(const fs::path& folder, const std::string& pattern) {
  std::string path;
  for (const char c : folder.string()) path += c == '%' ? std::string("%%") : std::string(1, c);
  return fmt::format("--output={}/{}", path, pattern);
}

std::string last_line(const fs::path& file) {
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) return "";
  std::istringstream lines(read_file(file));
  std::string last;
  for (std::string line; std::getline(lines, line);)
    if (!line.empty()) last = line;
  return last;
}

/// The jobs of one look.
class Stage {
 public:
  Stage(const CampaignCall& call, OpenCampaign& open, std::uint64_t look)
      : call_(call),
        open_(open),
        look_(look),
        folder_(fs::absolute(open.folder.path()) / "slurm" / fmt::format("look-{}", look)) {}

  /// To its end. False: detached.
  bool run() {
    std::size_t before = missing().size() + 1;
    bool found = find_jobs();
    for (;; found = false) {
      const std::vector<std::uint64_t> runs = missing();
      if (runs.empty() && !found) return true;
      if (!found) {
        if (runs.size() >= before) give_up(runs.size());
        before = runs.size();
        submit(runs);
      }
      if (call_.detach) return false;
      watch();
      open_.folder.merge(end());  // where the merge job died with its node
    }
  }

 private:
  std::uint64_t end() const { return look_ * open_.plan.runs_a_round(); }
  std::vector<std::uint64_t> missing() const { return open_.folder.missing(end()); }
  fs::path jobs_file() const { return folder_ / "jobs.txt"; }

  [[noreturn]] void give_up(std::size_t left) const {
    std::string why;
    for (int task = 0; task < tasks_ && why.empty(); ++task)
      why = last_line(folder_ / fmt::format("task-{}.out", task));
    throw MachineError(fmt::format("{} runs are missing, and the jobs ended without another one: {}", left,
                                   why.empty() ? "see " + folder_.string() : why));
  }

  /// Of an earlier call, that are in the queue still.
  bool find_jobs() {
    std::error_code ignored;
    if (!fs::is_regular_file(jobs_file(), ignored)) return false;
    std::istringstream words(read_file(jobs_file()));
    jobs_.clear();
    for (std::string job; words >> job;) jobs_.push_back(job);
    if (jobs_.empty() || slurm_.states(jobs_).empty()) return false;
    fmt::print(stderr, "goes on with Slurm's jobs {}\n", fmt::join(jobs_, ", "));
    return true;
  }

  void submit(const std::vector<std::uint64_t>& runs) {
    fs::create_directories(folder_);
    const fs::path todo = folder_ / "todo.txt";
    write_file(todo, fmt::format("{}\n", fmt::join(runs, "\n")));
    const int wanted = call_.tasks > 0 ? call_.tasks : kTasksAProcessor * slurm_.processors();
    tasks_ = std::clamp(wanted, 1,
                        std::min(kTasksMax, static_cast<int>(std::min<std::size_t>(runs.size(), kTasksMax))));
    const std::vector<std::string> words{fs::read_symlink("/proc/self/exe").string(), "campaign",
                                         fs::absolute(call_.file).string(), "--out",
                                         fs::absolute(open_.folder.path()).string()};
    std::vector<std::string> task = words;
    task.insert(task.end(), {"--todo", todo.string(), "--task"});
    write_file(folder_ / "task.sh", script_of(task, fmt::format("\"$SLURM_ARRAY_TASK_ID\"/{}", tasks_)));
    write_file(folder_ / "merge.sh", script_of(words, fmt::format("--merge {}", look_)));
    const std::string name = fmt::format("--job-name=understudy-{}", open_.campaign.name);
    const std::string memory =
        fmt::format("--mem={}M", static_cast<int>(std::ceil(memory_of_a_run(open_) / kMega)));
    std::vector<std::string> array = call_.sbatch;
    array.insert(array.end(), {name, memory, "--requeue", "--open-mode=append", "--ntasks=1",
                               fmt::format("--array=0-{}", tasks_ - 1), output_option(folder_, "task-%a.out"),
                               (folder_ / "task.sh").string()});
    const std::string job = slurm_.submit(array);
    jobs_ = {job};
    write_file(jobs_file(), job + "\n");
    std::vector<std::string> merge = call_.sbatch;
    merge.insert(merge.end(), {name, memory, "--requeue", "--open-mode=append", "--ntasks=1",
                               "--dependency=afterany:" + job, output_option(folder_, "merge.out"),
                               (folder_ / "merge.sh").string()});
    jobs_.push_back(slurm_.submit(merge));
    write_file(jobs_file(), fmt::format("{}\n", fmt::join(jobs_, "\n")));
    if (!call_.told.quiet)
      fmt::print(stderr, "{} runs are Slurm's job {} of {} tasks, merged by job {}\n", runs.size(), jobs_[0],
                 tasks_, jobs_[1]);
  }

  void watch() {
    ProgressLine line(!call_.told.quiet, {"tasks", tasks_ + 1.});
    try {
      for (;;) {
        const std::map<std::string, int> states = slurm_.states(jobs_);
        if (states.empty()) return;
        int left = 0;
        std::string text;
        for (const auto& [state, count] : states) {
          left += count;
          text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, state);
        }
        line.show(std::max(0.0, 1 - static_cast<double>(left) / (tasks_ + 1)), "Slurm: " + text);
        for (auto waited = std::chrono::milliseconds{0}; waited < kWatch;
             waited += std::chrono::milliseconds{100}) {
          stop_if_interrupted();
          std::this_thread::sleep_for(std::chrono::milliseconds{100});
        }
      }
    } catch (const Interrupted&) {
      slurm_.cancel(jobs_);
      fmt::print(stderr, "Slurm's jobs {} are cancelled; --resume goes on with the runs that are done\n",
                 fmt::join(jobs_, ", "));
      throw;
    }
  }

  const CampaignCall& call_;
  OpenCampaign& open_;
  std::uint64_t look_;
  fs::path folder_;
  SlurmClient slurm_;
  std::vector<std::string> jobs_;
  int tasks_ = 1;
};

/// 3 and 16 of "3/16".
std::pair<std::uint64_t, std::uint64_t> task_in(const std::string& word) {
  std::uint64_t task = 0, tasks = 0;
  const char* const end = word.data() + word.size();
  const auto first = std::from_chars(word.data(), end, task);
  const bool slash = first.ec == std::errc() && first.ptr != end && *first.ptr == '/';
  const auto second = slash ? std::from_chars(first.ptr + 1, end, tasks) : first;
  if (!slash || second.ec != std::errc() || second.ptr != end || task >= tasks)
    throw InputError(fmt::format("--task {} is none like 3/16", word));
  return {task, tasks};
}

std::string variable(const char* name) {
  const char* const value = std::getenv(name);
  return value ? value : "0";
}

}  // namespace

void add_slurm_options(CLI::App& command, CampaignCall& call) {
  command.add_flag("--slurm", call.slurm, "rehearse on a cluster: jobs of Slurm in place of processes here")
      ->group("Slurm");
  command
      .add_option("--tasks", call.tasks, "of the array of jobs, 1..1000; without it four for each processor")
      ->check(CLI::Range(1, kTasksMax))
      ->group("Slurm");
  command
      .add_option("--sbatch", call.sbatch,
                  "word for sbatch, such as --sbatch=--partition=long; may be given several times")
      ->allow_extra_args(false)
      ->group("Slurm");
  command
      .add_flag("--detach", call.detach,
                "return once the jobs are in the queue; --slurm --resume watches them")
      ->group("Slurm");
}

void check_slurm() { SlurmClient().check(); }

int run_on_slurm(const CampaignCall& call, OpenCampaign& open) {
  std::uint64_t rounds = 0;
  for (const std::uint64_t look : open.plan.looks()) {
    rounds = look;
    if (!Stage(call, open, look).run()) {
      fmt::print(call.told.json ? stderr : stdout,
                 "submitted: `understudy campaign {} --slurm --resume --out {}` watches the jobs\n",
                 call.file, call.folder);
      return kGood;
    }
    if (studies::narrow_enough(open.campaign, open.plan, look, open.rows)) break;
  }
  tell_result(open, rounds, call.told);
  return kGood;
}

int run_slurm_task(const CampaignCall& call, OpenCampaign& open) {
  const auto [task, tasks] = task_in(call.task);
  open.folder.check();
  std::vector<std::uint64_t> mine;
  std::istringstream words(read_file(call.todo));
  std::uint64_t run = 0;
  for (std::uint64_t at = 0; words >> run; ++at)
    if (at % tasks == task) mine.push_back(run);
  if (mine.empty()) return kGood;
  // Of a task that was started again only this attempt's file is its own: the one before may be writing
  // still, on a node that is believed dead.
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  const std::string begin = fmt::format("slurm-{}-{}-", variable("SLURM_ARRAY_JOB_ID"), task);
  const std::vector<std::uint64_t> missing = open.folder.missing(mine.back() + 1, begin);
  studies::ResultStore store(open.folder.part(begin + fmt::format("{}-{}-{}", variable("SLURM_RESTART_COUNT"),
                                                                  host.data(), ::getpid())),
                             open.folder.header());
  for (const std::uint64_t index : mine) {
    stop_if_interrupted();
    if (std::binary_search(missing.begin(), missing.end(), index))
      store.add(open.inputs.rehearse(open.plan.run(index)));
  }
  return kGood;
}

int run_slurm_merge(std::uint64_t rounds, OpenCampaign& open) {
  open.folder.check();
  const std::uint64_t end = rounds * open.plan.runs_a_round();
  open.folder.merge(end);
  if (const auto missing = open.folder.missing(end); !missing.empty())
    throw MachineError(fmt::format("{} runs are missing: their tasks died", missing.size()));
  if (rounds == open.plan.rounds() || studies::narrow_enough(open.campaign, open.plan, rounds, open.rows))
    write_result(open, rounds);
  return kGood;
}

}  // namespace understudy::cli
