#include "core/process/process_age.h"

#include <unistd.h>

#include <ctime>
#include <fstream>
#include <limits>
#include <string>

namespace understudy {

double process_age() {
  constexpr int kFieldsToStart = 19;  // of proc(5), from the one behind the name to starttime
  std::ifstream file("/proc/self/stat");
  file.ignore(std::numeric_limits<std::streamsize>::max(), ')');  // a name may have spaces
  std::string field;
  for (int i = 0; i < kFieldsToStart; ++i) file >> field;
  double started = 0;  // [ticks since the machine started]
  timespec now{};
  if (!(file >> started) || ::clock_gettime(CLOCK_BOOTTIME, &now) != 0) return 0;
  const double up = static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  return up - started / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

}  // namespace understudy
