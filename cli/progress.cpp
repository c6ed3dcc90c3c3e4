#include "cli/progress.h"

#include <unistd.h>

#include <fmt/format.h>

namespace understudy::cli {

ProgressLine::ProgressLine(bool wanted) : terminal_(wanted && ::isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (terminal_ && last_percent_ >= 0) fmt::print(stderr, "\r\033[K");
}

void ProgressLine::show(double share, const std::string& what) {
  const int percent = static_cast<int>(100 * share);
  if (!terminal_ || (percent == last_percent_ && what == last_what_)) return;
  last_percent_ = percent;
  last_what_ = what;
  fmt::print(stderr, "\r\033[K{:3d} % {}", percent, what);
  std::fflush(stderr);
}

}  // namespace understudy::cli
