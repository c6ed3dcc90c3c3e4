#include "calibration/plugin/process_usage.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>

namespace understudy::calibration {
namespace {
namespace fs = std::filesystem;

constexpr int kTasksMax = 10'000;

/// The numbers of /proc/PID/stat that follow the process's name, which may hold any character.
std::vector<long long> numbers_of(const fs::path& process) {
  std::ifstream file(process / "stat");
  std::string text;
  std::getline(file, text, '\0');
  const std::size_t name_end = text.rfind(')');
  std::vector<long long> numbers;
  if (name_end == std::string::npos || name_end + 3 > text.size()) return numbers;
  std::istringstream words(text.substr(name_end + 3));  // and the letter of its state
  for (long long number; words >> number;) numbers.push_back(number);
  return numbers;
}

void add_children(const fs::path& process, std::vector<pid_t>& children) {
  std::error_code ended;
  for (fs::directory_iterator task(process / "task", ended), end; !ended && task != end;
       task.increment(ended)) {
    std::ifstream file(task->path() / "children");
    for (pid_t child; file >> child;) children.push_back(child);
  }
}

}  // namespace

ProcessUsage usage_of(pid_t process) {
  // proc(5): ppid is the fourth field and the first number here.
  constexpr std::size_t kUserTime = 14 - 4, kChildrenSystemTime = 17 - 4, kThreads = 20 - 4,
                        kResident = 24 - 4;
  static const double ticks = static_cast<double>(::sysconf(_SC_CLK_TCK));
  static const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  ProcessUsage sum;
  std::vector<pid_t> left{process};
  while (!left.empty() && sum.tasks < kTasksMax) {
    const fs::path folder = fmt::format("/proc/{}", left.back());
    left.pop_back();
    const std::vector<long long> numbers = numbers_of(folder);
    if (numbers.size() <= kResident) continue;
    sum.tasks += static_cast<int>(numbers[kThreads]);
    for (std::size_t k = kUserTime; k <= kChildrenSystemTime; ++k)
      sum.cpu_time += static_cast<double>(numbers[k]) / ticks;
    sum.memory += static_cast<std::size_t>(numbers[kResident]) * page;
    add_children(folder, left);
  }
  return sum;
}

}  // namespace understudy::calibration
