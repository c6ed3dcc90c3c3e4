#include "cli/options/jobs_option.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/parallel.h"

namespace understudy::cli {

void add_jobs(CLI::App& command, int& threads, const std::string& about) {
  threads = hardware_threads();
  command.add_option("-j,--jobs", threads, about)->capture_default_str();
}

void check_jobs(int threads) {
  if (threads < 1 || threads > 1024) throw InputError(fmt::format("-j {} is outside 1..1024", threads));
}

}  // namespace understudy::cli
