#include "rehearsal/observers/trace_observer.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace understudy::rehearsal {

TraceObserver::TraceObserver(const sim::DepositionObserver& deposition, std::size_t capacity,
                             std::shared_ptr<const toolpath::RewrittenPath> asked)
    : deposition_(deposition),
      asked_(std::move(asked)),
      trace_(capacity),
      errors_(kErrorsPerPoint * capacity) {}

void TraceObserver::observe(const sim::Snapshot& s) {
  TracePoint point;
  point.time = s.time;
  point.line = s.line;
  point.extruding = trace_.count() > 0 && s.filament > filament_;
  point.X_WT = s.X_WT;
  point.X_WT_programmed = s.X_WT_commanded;
  point.X_WT_programmed.translation() -= offset_at(s.time);
  if (asked_) point.X_WT_programmed = asked_->asked(s.line, point.X_WT_programmed);
  point.tip_error = (point.X_WT.translation() - point.X_WT_programmed.translation()).norm();
  point.orientation_error = angle_between(point.X_WT.linear(), point.X_WT_programmed.linear());
  point.gap = deposition_.gap();
  point.axes = s.axes;
  if (point.extruding) {
    path_ += (s.X_WT.translation() - newest_.X_WT.translation()).norm();
    errors_.add(static_cast<float>(point.tip_error));
    square_sum_ += point.tip_error * point.tip_error;
    if (point.tip_error > tip_peak_.error) tip_peak_ = {point.tip_error, point.line, point.time};
    if (point.orientation_error > orientation_peak_.error)
      orientation_peak_ = {point.orientation_error, point.line, point.time};
  }
  point.path = path_;
  filament_ = std::max(filament_, s.filament);
  newest_ = point;
  trace_.add(point);
  if (told_) told_(point);
}

void TraceObserver::add_offset(const control::OffsetChange& change) { offsets_.push_back(change); }

Vec3 TraceObserver::offset_at(double time) {
  while (offsets_.size() > 1 && offsets_[1].time <= time) offsets_.pop_front();
  if (offsets_.empty() || offsets_.front().time > time) return Vec3::Zero();
  const auto& now = offsets_.front();
  if (offsets_.size() == 1 || !offsets_[1].gradual) return now.offset_W;
  const auto& next = offsets_[1];
  return now.offset_W + (time - now.time) / (next.time - now.time) * (next.offset_W - now.offset_W);
}

std::optional<AccuracyFigures> TraceObserver::accuracy() {
  if (errors_.count() == 0) return std::nullopt;
  const auto all = static_cast<double>(errors_.count());
  std::vector<float> errors = errors_.take();
  const auto n = errors.size();
  const auto p95 = errors.begin() + static_cast<std::ptrdiff_t>(std::min(
                                        n - 1, static_cast<std::size_t>(0.95 * static_cast<double>(n))));
  std::nth_element(errors.begin(), p95, errors.end());
  AccuracyFigures figures;
  figures.tip_rms_um = to_um(std::sqrt(square_sum_ / all));
  figures.tip_p95_um = to_um(static_cast<double>(*p95));
  figures.tip_max_um = to_um(tip_peak_.error);
  figures.orientation_max_mrad = 1e3 * orientation_peak_.error;
  return figures;
}

std::vector<TracePoint> TraceObserver::take() {
  std::vector<TracePoint> trace = trace_.take();
  if (!trace.empty() && trace.back().time < newest_.time) trace.push_back(newest_);
  return trace;
}

}  // namespace understudy::rehearsal
