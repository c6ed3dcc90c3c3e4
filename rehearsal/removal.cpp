#include "rehearsal/removal.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "geometry/inflated.h"
#include "machine/fixture_file.h"
#include "rehearsal/findings/place_text.h"

namespace understudy::rehearsal {
namespace {

RemovalFigures figures_of(const sim::RemovalSummary& summary) {
  RemovalFigures figures;
  figures.spacing_mm = to_mm(summary.spacing);
  figures.finished_fraction = summary.finished_fraction;
  figures.left_over_mean_um = to_um(summary.left_over_mean);
  figures.left_over_p95_um = to_um(summary.left_over_p95);
  figures.left_over_max_um = to_um(summary.left_over_max);
  figures.planned_left_over_p95_um = to_um(summary.planned_left_over_p95);
  figures.planned_left_over_max_um = to_um(summary.planned_left_over_max);
  figures.gouge_um = to_um(summary.gouge);
  figures.planned_gouge_um = to_um(summary.planned_gouge);
  for (int i = 0; i < 3; ++i) figures.gouge_mm[static_cast<std::size_t>(i)] = to_mm(summary.gouge_place_W[i]);
  figures.gouge_line = summary.gouge_line;
  figures.volume_mm3 = 1e9 * summary.volume;
  return figures;
}

Finding finding(const char* kind, Severity severity, double value, double limit) {
  Finding f;
  f.kind = kind;
  f.severity = severity;
  f.value = to_mm(value);
  f.limit = to_mm(limit);
  f.unit = "mm";
  return f;
}

}  // namespace

std::shared_ptr<const sim::Workblank> prepare_workblank(const SurfaceRequest& request,
                                                        const machine::MachineDescription& machine) {
  if (!request.depth_of_cut_mm && request.stock.empty()) return nullptr;
  if (machine.tool.prints())
    throw InputError(
        fmt::format("a stock or a depth of cut is for a machine with an end mill; {} prints", machine.name));
  if (request.intended.empty())
    throw InputError("a stock or a depth of cut needs the part that it becomes: --intended PART");
  if (request.depth_of_cut_mm && !request.stock.empty())
    throw InputError("the stock is a file or larger by a depth of cut, not both");
  auto blank = std::make_shared<sim::Workblank>();
  blank->part = geometry::read_stl(machine::find_fixture(request.intended));
  blank->stock = request.depth_of_cut_mm ? geometry::inflated(*blank->part, from_mm(*request.depth_of_cut_mm))
                                         : geometry::read_stl(machine::find_fixture(request.stock));
  blank->mill = sim::end_mill_of(machine.tool);
  return blank;
}

void study_removal(const TwinRun& run, const machine::AcceptedErrors& accepted, Record& record) {
  if (!run.removal) return;
  const sim::RemovalSummary& summary = *run.removal;
  record.removal = figures_of(summary);
  record.milled = run.milled;
  if (summary.gouge > accepted.tip) {
    Finding f = finding("gouge", Severity::error, summary.gouge, accepted.tip);
    f.gcode_line = summary.gouge_line;
    f.message = fmt::format("the end mill cuts {:.3f} mm into the part at {}, deeper than {:.3f} mm", f.value,
                            place_text(summary.gouge_place_W), f.limit);
    record.findings.push_back(std::move(f));
  }
  if (!(summary.finished_fraction > 0)) {
    Finding f = finding("left_over", Severity::error, 0, 0);
    f.message = "the program takes nothing off the stock";
    record.findings.push_back(std::move(f));
  } else if (summary.left_over_p95 > accepted.tip) {
    Finding f = finding("left_over", Severity::warning, summary.left_over_p95, accepted.tip);
    f.message =
        fmt::format("on 5 % of what the program mills {:.3f} mm and more are left over, above {:.3f} mm",
                    f.value, f.limit);
    record.findings.push_back(std::move(f));
  }
}

}  // namespace understudy::rehearsal
