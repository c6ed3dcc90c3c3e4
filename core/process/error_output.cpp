#include "core/process/error_output.h"

#include <utility>

namespace understudy {
namespace {

constexpr std::string_view kName = "understudy: ";

bool may_be_kept(std::string_view line) { return line.starts_with(kName) || kName.starts_with(line); }

}  // namespace

std::string ErrorOutput::take(std::string_view bytes) {
  std::string out;
  for (const char c : bytes) {
    const bool end = c == '\n' || c == '\r';
    if (passing_) {
      out += c;
      passing_ = !end;
      continue;
    }
    line_ += c;
    if (end && line_.starts_with(kName)) {
      out += std::exchange(kept_, std::exchange(line_, {}));
    } else if (end || !may_be_kept(line_)) {
      out += std::exchange(line_, {});
      passing_ = !end;
    }
  }
  return out;
}

std::string ErrorOutput::rest() { return std::exchange(kept_, {}) + std::exchange(line_, {}); }

std::string ErrorOutput::reason() const {
  if (kept_.empty()) return {};
  const std::string line = kept_.substr(kName.size());
  return line.substr(0, line.find_last_not_of("\r\n") + 1);
}

}  // namespace understudy
