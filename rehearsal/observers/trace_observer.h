// Keeps the truth beside the command, and how far apart they were, in bounded memory.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <vector>

#include "control/print.h"
#include "rehearsal/observers/thinned_series.h"
#include "rehearsal/record.h"
#include "sim/deposition/deposition.h"
#include "sim/observer.h"
#include "toolpath/gcode/rewrite/rewritten_path.h"

namespace understudy::rehearsal {

/// The largest of its kind while extruding, and where.
struct ErrorPeak {
  double error = 0;  ///< [m] or [rad]
  int line = 0;
  double time = 0;  ///< [s]
};

class TraceObserver : public sim::Observer {
 public:
  static constexpr std::size_t kCapacity = 100'000, kErrorsPerPoint = 20;
  /// Reads the gap from `deposition`, which must have seen each snapshot before. Of the snapshots, a trace of
  /// at most `capacity` is kept: when it is full, every other one of it goes and from then on twice as few
  /// are added. The figures are those of all snapshots, but for the 95th percentile: that is taken of
  /// at most kErrorsPerPoint * `capacity` of them, evenly spaced.
  /// `asked`: where another program asked for the tool, which the one that runs was compensated from; null:
  /// the one that runs asks itself.
  explicit TraceObserver(const sim::DepositionObserver& deposition, std::size_t capacity = kCapacity,
                         std::shared_ptr<const toolpath::RewrittenPath> asked = nullptr);

  void observe(const sim::Snapshot& snapshot) override;
  /// What the gap controller adds to the program from a time on; told in order of time.
  void add_offset(const control::OffsetChange& change);

  /// Each point as it comes, before any is thinned out; on the thread that observes.
  void on_point(std::function<void(const TracePoint&)> told) { told_ = std::move(told); }

  /// Nothing while nothing was extruded. To be asked once.
  std::optional<AccuracyFigures> accuracy();
  ErrorPeak tip_peak() const { return tip_peak_; }
  ErrorPeak orientation_peak() const { return orientation_peak_; }
  std::vector<TracePoint> take();
  int stride() const { return static_cast<int>(trace_.stride()); }  ///< snapshots a point of the trace

 private:
  Vec3 offset_at(double time);

  const sim::DepositionObserver& deposition_;
  std::shared_ptr<const toolpath::RewrittenPath> asked_;
  ThinnedSeries<TracePoint> trace_;
  TracePoint newest_;
  std::function<void(const TracePoint&)> told_;
  std::deque<control::OffsetChange> offsets_;  ///< the one in force, and those to come
  double filament_ = 0;
  double path_ = 0;
  ThinnedSeries<float> errors_;  // [m], of the tip while extruding
  double square_sum_ = 0;
  ErrorPeak tip_peak_, orientation_peak_;
};

}  // namespace understudy::rehearsal
