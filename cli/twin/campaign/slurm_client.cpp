#include "cli/twin/campaign/slurm_client.h"

#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <memory>
#include <sstream>
#include <system_error>
#include <thread>

#include <fmt/format.h>

#include "cli/command.h"
#include "core/error.h"
#include "core/interrupt.h"
#include "core/text/trimmed.h"

namespace understudy::cli {
namespace {

constexpr int kNoSuchProgram = 127;
constexpr int kQuestions = 30;  // to a controller that does not answer, each two seconds after the one before
constexpr std::chrono::seconds kBetween{2};

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

/// Whom squeue does not know any more.
bool unknown_job(const std::string& answer) { return answer.find("Invalid job id") != std::string::npos; }

}  // namespace

ProgramAnswer run_program(const std::vector<std::string>& words) {
  std::string command;
  for (const std::string& word : words) command += shell_quoted(word) + " ";
  std::FILE* pipe = ::popen((command + "</dev/null 2>&1").c_str(), "re");
  if (!pipe) throw MachineError("cannot start a process: " + std::generic_category().message(errno));
  ProgramAnswer answer;
  std::array<char, 4096> bytes;
  while (const std::size_t got = std::fread(bytes.data(), 1, bytes.size(), pipe))
    answer.output.append(bytes.data(), got);
  const int status = ::pclose(pipe);
  answer.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
  return answer;
}

void SlurmClient::check() const {
  for (const char* program : {"sbatch", "squeue", "scancel"})
    if (run_program({program, "--version"}).status == kNoSuchProgram)
      throw InputError(
          fmt::format("--slurm: there is no program {}: install Slurm's client programs (Debian: "
                      "slurm-client), or leave --slurm out",
                      program));
  if (const ProgramAnswer answer =
          run_program({"squeue", "--noheader", "--states=all", "--name=understudy-asks"});
      answer.status != 0)
    throw MachineError(fmt::format("Slurm's controller does not answer: {}", first_line(answer.output)));
}

std::string SlurmClient::submit(const std::vector<std::string>& words) const {
  std::vector<std::string> all{"sbatch", "--parsable"};
  all.insert(all.end(), words.begin(), words.end());
  const ProgramAnswer answer = run_program(all);
  const std::string job = answer.output.substr(0, answer.output.find_first_of(";\n"));
  if (answer.status != 0 || job.empty() || job.find_first_not_of("0123456789") != std::string::npos)
    throw MachineError(fmt::format("Slurm does not take the job: {}", first_line(answer.output)));
  return job;
}

std::map<std::string, int> SlurmClient::states(const std::vector<std::string>& jobs) const {
  ProgramAnswer answer;
  for (int question = 0; question < kQuestions; ++question) {
    stop_if_interrupted();
    answer = run_program({"squeue", "--noheader", "--array", "--format=%T", "--jobs=" + joined(jobs, ",")});
    if (unknown_job(answer.output)) return {};
    if (answer.status == 0) break;
    std::this_thread::sleep_for(kBetween);
  }
  if (answer.status != 0)
    throw MachineError(
        fmt::format("Slurm's controller does not answer any more: {}; --resume goes on with the jobs",
                    first_line(answer.output)));
  std::map<std::string, int> states;
  std::istringstream lines(answer.output);
  for (std::string state; lines >> state;) ++states[state];
  return states;
}

void SlurmClient::cancel(const std::vector<std::string>& jobs) const {
  std::vector<std::string> words{"scancel", "--quiet"};
  words.insert(words.end(), jobs.begin(), jobs.end());
  static_cast<void>(run_program(words));
}

int SlurmClient::processors() const {
  const ProgramAnswer answer =
      run_program({"sinfo", "--noheader", "--format=%C"});  // allocated/idle/other/total
  const std::size_t slash = answer.output.rfind('/');
  int count = 1;
  if (answer.status == 0 && slash != std::string::npos)
    std::from_chars(answer.output.data() + slash + 1, answer.output.data() + answer.output.size(), count);
  return std::max(1, count);
}

}  // namespace understudy::cli
