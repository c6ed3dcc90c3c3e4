#include "cli/drive/gap_latency.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "machine/record/record_reader.h"

namespace understudy::cli {
namespace {

constexpr std::array kUpTo{0.02, 0.03, 0.05, 0.1, 0.2, 0.5};  // [s]

}  // namespace

std::string gap_latency_line(const std::string& record) {
  std::array<int, kUpTo.size() + 1> counts{};
  std::optional<double> exposed;
  std::vector<double> latencies;
  machine::read_record(record, [&](const machine::RecordedEntry& entry) {
    const auto* frame = std::get_if<machine::RecordedFrame>(&entry);
    if (frame && frame->answer == machine::Status::ok) exposed = frame->frame.exposed_at;
    const auto* submit = std::get_if<machine::RecordedSubmit>(&entry);
    if (!submit || submit->answer != machine::Status::ok || !exposed) return;
    const double latency = submit->now - *exposed;
    latencies.push_back(latency);
    ++counts[static_cast<std::size_t>(std::ranges::lower_bound(kUpTo, latency) - kUpTo.begin())];
    exposed.reset();
  });
  if (latencies.empty()) return "";
  std::ranges::sort(latencies);
  std::string line =
      fmt::format("gap loop, exposure to setpoints queued: median {:.0f} ms, {:.0f} ms at most;",
                  1e3 * latencies[latencies.size() / 2], 1e3 * latencies.back());
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) continue;
    line += i < kUpTo.size() ? fmt::format(" to {:.0f} ms {},", 1e3 * kUpTo[i], counts[i])
                             : fmt::format(" longer {},", counts[i]);
  }
  line.pop_back();
  return line;
}

}  // namespace understudy::cli
