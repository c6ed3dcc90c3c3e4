#include "cli/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <utility>

#include <fmt/format.h>

namespace understudy::cli {
namespace {

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// A line that is broken in two is not rewritten by the next.
std::string cut_to_terminal(std::string text) {
  winsize size{};
  if (::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col < 2) return text;
  std::size_t end = std::min<std::size_t>(text.size(), size.ws_col - 1U);
  const auto inside_character = [&] { return (static_cast<unsigned char>(text[end]) & 0xc0U) == 0x80U; };
  while (end > 0 && end < text.size() && inside_character()) --end;
  text.resize(end);
  return text;
}

}  // namespace

ProgressLine::ProgressLine(bool wanted, ProgressUnit unit) : terminal_(::isatty(STDERR_FILENO) == 1) {
  if (wanted)
    pace_.emplace(terminal_ ? ProgressPace::To::terminal : ProgressPace::To::pipe, seconds_now(),
                  std::move(unit));
}

ProgressLine::~ProgressLine() { clear(); }

void ProgressLine::clear() {
  const std::scoped_lock lock(mutex_);
  if (terminal_ && shown_) fmt::print(stderr, "\r\033[K");
  shown_ = false;
}

void ProgressLine::show(double share, const std::string& what) {
  if (!pace_) return;
  const std::scoped_lock lock(mutex_);
  const auto text = pace_->update(share, what, seconds_now());
  if (!text) return;
  shown_ = true;
  if (terminal_)
    fmt::print(stderr, "\r\033[K{}", cut_to_terminal(*text));
  else
    fmt::print(stderr, "{}\n", *text);
  std::fflush(stderr);
}

Progress ProgressLine::teller() {
  return [this](double share, const std::string& what) { show(share, what); };
}

}  // namespace understudy::cli
