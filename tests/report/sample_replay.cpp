#include "tests/report/sample_replay.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/units.h"
#include "machine/description.h"
#include "rehearsal/observers/thinned_series.h"
#include "rehearsal/observers/trace_observer.h"
#include "sim/as_built/as_built.h"
#include "tests/report/sample_record.h"

namespace understudy::report {
namespace {

using namespace rehearsal;

std::array<float, 3> floats(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

sim::Bead bead_between(const TracePoint& from, const TracePoint& to, double width) {
  sim::Bead bead;
  bead.from_W = floats(from.X_WT.translation());
  bead.to_W = floats(to.X_WT.translation());
  bead.up_W = floats(tool_axis(to.X_WT));
  bead.width = static_cast<float>(width);
  bead.height = 0.15e-3f;
  bead.laid_at = static_cast<float>(to.time);
  bead.line = to.line;
  return bead;
}

}  // namespace

void add_sample_replay(Record& record) {
  const auto machine = machine::load_machine("hexapod");
  const auto as_built = sim::as_described(machine);
  std::vector<Moment> moments;
  for (const TracePoint& point : record.trace) moments.push_back({point.time, {point.X_WT, point.axes}});
  record.replay = make_replay(machine, as_built, moments, 200);
  const int lines = record.trace.back().line;
  for (int line = 1; line <= lines; ++line)
    record.replay->program +=
        fmt::format("G1 X{:.3f} Y{:.3f} E0.02 ; <b>line</b> {}\n", 0.01 * line, 0.02 * line, line);
  record.replay->features = {{1, "Perimeter"}, {lines / 2, "Infill"}};
  record.scene = machine_scene(machine, as_built, moments[moments.size() / 2].configuration);
  record.scene->simulated = true;
  record.scene->time = moments[moments.size() / 2].time;
  auto workpiece = std::make_shared<sim::Workpiece>(nullptr);
  const TracePoint* last = nullptr;
  for (const TracePoint& point : record.trace) {
    if (!point.extruding) {
      last = nullptr;
    } else if (!last) {
      last = &point;
    } else if (point.path - last->path > 0.4e-3) {
      workpiece->add(bead_between(*last, point, 0.48e-3 + 0.03e-3 * std::sin(300 * point.path)));
      last = &point;
    }
  }
  record.scene->printed = std::move(workpiece);
}

/// As a rehearsal does: beads come of all that happens, the trace keeps no more than its capacity.
void thin_trace(Record& record) {
  ThinnedSeries<TracePoint> kept(TraceObserver::kCapacity);
  for (const TracePoint& point : record.trace) kept.add(point);
  record.trace_stride = static_cast<int>(kept.stride());
  record.trace = kept.take();
}

Record sample_large(int moves) {
  Record record = sample_no_go();
  record.title = "vase.gcode on hexapod";
  record.program_name = "vase.gcode";
  record.trace.clear();
  record.trace_without_gap_control.clear();
  const double step = 0.5e-3;
  double angle = 0;
  for (int i = 0; i <= moves; ++i) {
    const double turns = angle / (2 * std::numbers::pi);
    const double radius = 20e-3 + 4e-3 * std::sin(0.02 * turns) + (i % 2 ? 0.2e-3 : -0.2e-3);
    angle += step / radius;
    TracePoint point;
    point.time = 0.05 * i;
    point.line = i + 1;
    point.extruding = i > 0;
    point.path = step * i;
    point.X_WT.translation() = Vec3(radius * std::cos(angle), radius * std::sin(angle), 0.2e-3 * turns);
    point.X_WT_programmed = point.X_WT;
    point.gap = 0.15e-3 + 0.08e-3 * std::sin(0.01 * i);
    point.tip_error = 40e-6 + 30e-6 * std::sin(0.003 * i);
    for (std::size_t a = 0; a < 6; ++a) point.axes[a] = 0.2 + 0.02 * std::sin(angle + static_cast<double>(a));
    record.trace.push_back(point);
  }
  const double longer = record.trace.back().time / record.curves.stretches.back().end;
  for (CurveStretch& stretch : record.curves.stretches) stretch.begin *= longer, stretch.end *= longer;
  for (sim::LoadFlip& flip : record.curves.flips) flip.time *= longer;
  for (std::size_t i = 0; i < record.findings.size(); ++i) {
    record.findings[i].gcode_line = static_cast<int>(1 + i * static_cast<std::size_t>(moves) / 40);
    record.findings[i].time_s = 0.05 * record.findings[i].gcode_line;
  }
  add_sample_replay(record);
  thin_trace(record);
  return record;
}

}  // namespace understudy::report
