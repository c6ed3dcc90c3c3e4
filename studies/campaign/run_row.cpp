#include "studies/campaign/run_row.h"

#include <array>

#include "core/error.h"

namespace understudy::studies {
namespace {

constexpr std::array kWords{"go", "no-go", "refused", "failed", "crashed"};

}  // namespace

const char* to_string(RunEnd end) { return kWords[static_cast<std::size_t>(end)]; }

RunEnd run_end(const std::string& word) {
  for (std::size_t i = 0; i < kWords.size(); ++i)
    if (word == kWords[i]) return static_cast<RunEnd>(i);
  throw InputError("'" + word + "' is no end of a run");
}

const std::vector<std::string>& row_metrics() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const std::string& name : regression::metric_names())
      if (!regression::metric_is_text(name) && !regression::metric_is_of_the_run(name) &&
          !regression::metric_is_of_series(name) && name != "exit_status")
        all.push_back(name);
    return all;
  }();
  return names;
}

}  // namespace understudy::studies
