// One line on a terminal that is rewritten; in a pipe a plain line every ten seconds.
#pragma once

#include <mutex>
#include <optional>
#include <string>

#include "core/progress.h"
#include "core/progress_meter.h"

namespace understudy::cli {

class ProgressLine {
 public:
  /// Shows nothing anywhere unless `wanted`. With a `unit` the rate counts it, else per cent.
  explicit ProgressLine(bool wanted = true, ProgressUnit unit = {});
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(double share, const std::string& what);
  /// Off the terminal, so that other text may be printed; the next show() brings it back.
  void clear();
  /// show(), for who takes a function; not to be called after the line's end.
  Progress teller();

 private:
  bool terminal_, shown_ = false;
  std::optional<ProgressPace> pace_;  ///< none: silent
  std::mutex mutex_;                  ///< threads of a work pool tell how far each is
};

/// Work that tells its progress: `work(progress)`, and what it returns. Before anything else is printed the
/// line is gone.
template <typename Work>
auto with_progress(bool wanted, Work work) {
  ProgressLine line(wanted);
  return work(line.teller());
}

}  // namespace understudy::cli
