// Bytes as the summary of a rehearsal, and behind a line "---" its trace, in a folder of results whose
// manifest names both.
#include <algorithm>

#include "core/digest.h"
#include "core/file/output_folder.h"
#include "report/recorded/recorded_rehearsal.h"
#include "report/recorded/verification.h"
#include "tests/fuzz/reader.h"

namespace understudy::fuzz {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view kMark = "\n---\n";

fs::path write(const std::string& name, std::string_view summary, std::string_view trace) {
  const fs::path folder = InputFile::folder() / name;
  fs::create_directories(folder);
  std::string manifest;
  const auto add = [&](const std::string& file, std::string_view content) {
    InputFile(name + "/" + file).fill(content);
    manifest += sha256_hex(std::string(content)) + "  " + file + "\n";
  };
  add("summary.json", summary);
  add("trace.csv", trace);
  InputFile(name + "/" + kManifest).fill(manifest);
  return folder;
}

/// The same but for the last digit, where there is one.
std::string changed(std::string_view text) {
  std::string other(text);
  const auto digit = std::find_if(other.rbegin(), other.rend(), [](char c) { return c >= '0' && c <= '9'; });
  if (digit != other.rend()) *digit = *digit == '7' ? '8' : '7';
  return other;
}

void check(const report::RecordedRehearsal& read) {
  for (const auto& [name, figure] : read.figures)
    if (const auto* number = std::get_if<double>(&figure)) require_finite(*number, name);
  for (const auto& group : read.findings) {
    require(group.count >= 0 && group.first_line >= 0 && group.last_line >= 0, "a count below zero");
    require_finite(std::vector{group.worst.time_s, group.worst.value, group.worst.limit}, "a finding");
  }
  double time = -1e300;
  for (const auto& point : read.trace) {
    require_finite(std::vector{point.time, point.tip_error, point.orientation_error, point.path}, "a point");
    require(point.line >= 0 && point.time >= time && !std::isnan(point.gap), "a point of no trace");
    time = point.time;
  }
}

}  // namespace
}  // namespace understudy::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understudy;
  const std::string_view text = fuzz::text_of(data, size);
  const std::size_t mark = std::min(text.find(fuzz::kMark), text.size());
  const std::string_view summary = text.substr(0, mark),
                         trace = text.substr(std::min(mark + fuzz::kMark.size(), text.size()));
  const auto folder = fuzz::write("results", summary, trace),
             other = fuzz::write("other", fuzz::changed(summary), fuzz::changed(trace));
  report::RecordedRehearsal read;
  if (fuzz::accepts(size, folder.string(), [&] { read = report::read_recorded_rehearsal(folder); }))
    fuzz::check(read);
  fuzz::require(report::compare_results(folder, folder).empty(), "a folder that differs from itself");
  for (const auto& difference : report::compare_results(folder, other))
    fuzz::require(!difference.details.empty(), "a difference without words");
  return 0;
}
