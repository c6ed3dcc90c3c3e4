#include "core/process/memory.h"

#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace understudy {
namespace {

// [bytes]: a campaign's next run soon asks for as much as its last one left.
constexpr std::size_t kWorthReturning = 48'000'000;
constexpr std::uint64_t kUnknown = std::numeric_limits<std::uint64_t>::max();

/// "MemAvailable:   12345 kB"
std::uint64_t system_free() {
  std::ifstream file("/proc/meminfo");
  std::string word;
  std::uint64_t kilobytes = 0;
  while (file >> word)
    if (word == "MemAvailable:" && file >> kilobytes) return 1024 * kilobytes;
  return kUnknown;
}

std::uint64_t number_in(const char* file) {
  std::uint64_t value = 0;
  return std::ifstream(file) >> value ? value : kUnknown;
}

/// Of a container: version 2 of control groups, at the root that the process sees.
std::uint64_t group_free() {
  const std::uint64_t most = number_in("/sys/fs/cgroup/memory.max"),
                      used = number_in("/sys/fs/cgroup/memory.current");
  if (most == kUnknown || used == kUnknown) return kUnknown;
  return most - std::min(used, most);
}

std::uint64_t own_free() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kUnknown;
  return limit.rlim_cur - std::min<std::uint64_t>(mapped_memory(), limit.rlim_cur);
}

}  // namespace

std::uint64_t available_memory() {
  const std::uint64_t least = std::min({system_free(), group_free(), own_free()});
  return least == kUnknown ? 0 : least;
}

std::uint64_t mapped_memory() {
  const std::uint64_t pages = number_in("/proc/self/statm");
  return pages == kUnknown ? 0 : pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

void return_free_memory() {
  if (::mallinfo2().fordblks >= kWorthReturning) ::malloc_trim(0);
}

}  // namespace understudy
