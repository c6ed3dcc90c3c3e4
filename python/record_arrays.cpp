#include "python/record_arrays.h"

#include <cmath>

#include "machine/pose_array.h"
#include "python/arrays.h"
#include "vision/dot/dot.h"

namespace understudy::python {
namespace {

using rehearsal::TracePoint;

constexpr auto kStride = static_cast<py::ssize_t>(sizeof(TracePoint));

py::array poses_of(const std::vector<TracePoint>& trace, Pose TracePoint::*pose) {
  py::array_t<double> rows(
      {static_cast<py::ssize_t>(trace.size()), static_cast<py::ssize_t>(machine::kPoseNumbers)});
  double* row = rows.mutable_data();
  for (const TracePoint& point : trace) {
    kinematics::write_pose(point.*pose, row);
    row += machine::kPoseNumbers;
  }
  return rows;
}

template <typename Number, typename Value>
py::array column_of(const std::vector<TracePoint>& trace, Value TracePoint::*value) {
  py::array_t<Number> column(static_cast<py::ssize_t>(trace.size()));
  Number* at = column.mutable_data();
  for (const TracePoint& point : trace) *at++ = static_cast<Number>(point.*value);
  return column;
}

py::dict arrays_of(const std::vector<TracePoint>& trace, std::size_t axis_count, const py::object& owner) {
  const auto count = static_cast<py::ssize_t>(trace.size());
  static const TracePoint none;
  const TracePoint& first = trace.empty() ? none : trace.front();
  const auto view = [&](const double& number) { return view_of(&number, count, kStride, owner); };
  py::dict arrays;
  arrays["time"] = view(first.time);
  arrays["line"] = column_of<std::int64_t>(trace, &TracePoint::line);
  arrays["extruding"] = column_of<bool>(trace, &TracePoint::extruding);
  arrays["pose"] = poses_of(trace, &TracePoint::X_WT);
  arrays["programmed_pose"] = poses_of(trace, &TracePoint::X_WT_programmed);
  arrays["tip"] = view_of_rows(first.X_WT.matrix().col(3).data(), count, 3, kStride, owner);
  arrays["programmed_tip"] =
      view_of_rows(first.X_WT_programmed.matrix().col(3).data(), count, 3, kStride, owner);
  arrays["tip_error"] = view(first.tip_error);
  arrays["orientation_error"] = view(first.orientation_error);
  arrays["gap"] = view(first.gap);
  arrays["path"] = view(first.path);
  arrays["axes"] =
      view_of_rows(first.axes.data(), count, static_cast<py::ssize_t>(axis_count), kStride, owner);
  return arrays;
}

py::object pixel_of(bool there, const Vec2& pixel) {
  if (!there) return py::none();
  return copied({pixel.data(), 2});
}

}  // namespace

py::dict trace_arrays(const std::shared_ptr<rehearsal::Record>& record) {
  return arrays_of(record->trace, record->axes.size(), py::cast(record));
}

py::dict trace_arrays(std::vector<TracePoint> trace, std::size_t axis_count) {
  auto kept = std::make_unique<std::vector<TracePoint>>(std::move(trace));
  const auto* const points = kept.get();
  const py::capsule owner(kept.release(), [](void* of) { delete static_cast<std::vector<TracePoint>*>(of); });
  return arrays_of(*points, axis_count, owner);
}

py::list frame_records(const std::shared_ptr<rehearsal::Record>& record) {
  py::list frames;
  for (const rehearsal::FrameRecord& frame : record->frames) {
    const control::GapSample& look = frame.look;
    py::dict told;
    told["time"] = look.time;
    told["image"] = picture_of(look.frame.image);
    told["region"] = py::make_tuple(look.frame.image.region.x, look.frame.image.region.y,
                                    look.frame.image.region.width, look.frame.image.region.height);
    told["dot"] = vision::to_string(look.dot.status);
    told["dot_px"] = pixel_of(look.dot.status != vision::DotStatus::no_dot, look.dot.position_px);
    told["reading"] = look.reading.sigma > 0 ? py::object(py::float_(look.reading.gap)) : py::none();
    told["used"] = look.used;
    told["why"] = look.why;
    told["true_gap"] = frame.true_gap;
    told["true_dot_px"] = pixel_of(frame.true_dot_px.has_value(), frame.true_dot_px.value_or(Vec2::Zero()));
    frames.append(told);
  }
  return frames;
}

}  // namespace understudy::python
