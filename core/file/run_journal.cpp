#include "core/file/run_journal.h"

#include <cerrno>
#include <charconv>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/file/output_file.h"
#include "core/file/staged_file.h"

namespace understudy {
namespace {

constexpr const char* kSchema = "understudy.journal/1";

/// The shortest numbers that read back as the same.
std::string line_of(const RunJournal::Answer& answer) { return fmt::format("{}", fmt::join(answer, " ")); }

RunJournal::Answer answer_in(const std::string& line) {
  RunJournal::Answer answer;
  const char *at = line.data(), *const end = at + line.size();
  while (at < end) {
    double value = std::numeric_limits<double>::quiet_NaN();
    const auto read = std::from_chars(at, end, value);
    if (read.ec != std::errc()) break;
    answer.push_back(value);
    at = read.ptr == end ? end : read.ptr + 1;
  }
  return answer;
}

std::map<std::size_t, std::string> lines_in(const std::filesystem::path& path, const std::string& study) {
  std::map<std::size_t, std::string> lines;
  std::ifstream file(path, std::ios::binary);
  std::string line;
  if (!std::getline(file, line) || line != study) return lines;
  while (std::getline(file, line) && !file.eof()) {
    std::size_t item = 0;
    const char* const end = line.data() + line.size();
    const auto read = std::from_chars(line.data(), end, item);
    if (read.ec != std::errc() || read.ptr == end || *read.ptr != ' ') break;
    lines[item] = std::string(read.ptr + 1, end);
  }
  return lines;
}

}  // namespace

RunJournal::RunJournal(std::filesystem::path path, std::string study)
    : path_(std::move(path)), study_(fmt::format("{} {}", kSchema, study)) {
  if (path_.empty()) return;
  check_writable(path_);
  lines_ = lines_in(path_, study_);
  begin();
}

/// Written whole, so that no half line stays in the middle.
void RunJournal::begin() {
  if (path_.empty()) return;
  file_.close();
  std::string content = study_ + '\n';
  for (const auto& [item, line] : lines_) content += fmt::format("{} {}\n", item, line);
  write_file(path_, content);
  file_.open(path_, std::ios::binary | std::ios::app);
  if (!file_) failed_to_write(path_, errno);
}

bool RunJournal::confirm(const Answer& answer) {
  const auto found = lines_.find(0);
  if (found != lines_.end() && found->second == line_of(answer)) return true;
  lines_.clear();
  begin();
  add(0, answer);
  return false;
}

std::optional<RunJournal::Answer> RunJournal::find(std::size_t item) const {
  const std::scoped_lock lock(mutex_);
  const auto found = lines_.find(item);
  return found == lines_.end() ? std::nullopt : std::optional(answer_in(found->second));
}

void RunJournal::add(std::size_t item, const Answer& answer) {
  const std::scoped_lock lock(mutex_);
  const std::string& line = lines_[item] = line_of(answer);
  if (path_.empty()) return;
  file_ << item << ' ' << line << '\n';
  file_.flush();
  if (!file_) failed_to_write(path_, errno);
}

void RunJournal::remove() {
  file_.close();
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

}  // namespace understudy
