#include "calibration/plugin/process_limits.h"

#include <signal.h>
#include <sys/wait.h>

#include <cstring>

#include <fmt/format.h>

namespace understudy::calibration {
namespace {

std::string told_bytes(std::size_t bytes) {
  const auto value = static_cast<double>(bytes);
  if (value >= 1e9) return fmt::format("{:g} GB", value * 1e-9);
  if (value >= 1e6) return fmt::format("{:g} MB", value * 1e-6);
  return fmt::format("{} bytes", bytes);
}

std::string too_much_cpu(const ProcessLimits& limits) {
  return fmt::format("used more than {:g} s of CPU time", limits.cpu_time());
}

/// The kernel refuses a program what is beyond a limit and does not tell us; most programs say so.
std::string limit_told_of(const std::string& error_output, const ProcessLimits& limits) {
  const auto tells = [&](const char* words) { return error_output.find(words) != std::string::npos; };
  if (tells("MemoryError") || tells("bad_alloc") || tells("annot allocate memory") || tells("ut of memory"))
    return told_bytes(limits.memory) + " of memory";
  if (tells("File too large")) return told_bytes(limits.file) + " of a file";
  if (tells("No space left on device")) return told_bytes(limits.own_folders) + " of temporary files";
  if (tells("Too many open files")) return fmt::format("{} open files", limits.open_files);
  return {};
}

}  // namespace

std::string exceeded(const ProcessUsage& usage, const ProcessLimits& limits) {
  if (usage.memory > limits.memory)
    return fmt::format("used more than {} of memory", told_bytes(limits.memory));
  if (usage.tasks > limits.processes)
    return fmt::format("started more than {} processes and threads", limits.processes);
  if (usage.cpu_time > limits.cpu_time()) return too_much_cpu(limits);
  return {};
}

std::string told_ending(int status, const std::string& error_output, const ProcessLimits& limits) {
  // A shell tells the death of its command as 128 and the signal.
  const bool by_shell =
      WIFEXITED(status) && WEXITSTATUS(status) > 128 && WEXITSTATUS(status) < 128 + SIGRTMIN;
  std::string ending;
  if (WIFSIGNALED(status) || by_shell) {
    const int signal = by_shell ? WEXITSTATUS(status) - 128 : WTERMSIG(status);
    if (signal == SIGXCPU) return too_much_cpu(limits);
    if (signal == SIGXFSZ) return fmt::format("wrote a file of more than {}", told_bytes(limits.file));
    ending = fmt::format("crashed with signal {} ({})", signal, ::strsignal(signal));
  } else if (WEXITSTATUS(status) == 127) {
    ending = "the command was not found (status 127)";
  } else {
    ending = fmt::format("ended with status {}", WEXITSTATUS(status));
  }
  const std::string limit = limit_told_of(error_output, limits);
  return limit.empty() ? ending : fmt::format("{} at its limit of {}", ending, limit);
}

std::string brief(const std::string& text, std::size_t length) {
  std::string line;
  for (const char c : text) {
    if (c == '\n' && line.find_first_not_of(" \t") != std::string::npos) break;
    line += c >= ' ' && c <= '~' ? c : ' ';
    if (line.size() > length) {
      line.resize(length);
      return line + "...";
    }
  }
  const std::size_t first = line.find_first_not_of(' ');
  return first == std::string::npos ? "" : line.substr(first);
}

std::string last_words(const std::string& error_output) {
  const std::string first = brief(error_output);
  if (!first.starts_with("Traceback")) return first;
  const std::size_t end = error_output.find_last_not_of(" \t\r\n");
  const std::size_t before = error_output.rfind('\n', end);
  return brief(error_output.substr(before == std::string::npos ? 0 : before + 1));
}

}  // namespace understudy::calibration
