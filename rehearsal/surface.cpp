#include "rehearsal/surface.h"

#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "core/units.h"
#include "machine/fixture_file.h"
#include "sim/surface/as_printed.h"
#include "sim/surface/deviation.h"
#include "sim/surface/roughness.h"
#include "sim/surface/surface_profile.h"

namespace understudy::rehearsal {
namespace {

constexpr std::size_t kChartPoints = 4000;

void measure_line(const SurfaceTask& task, const sim::Workpiece& workpiece, Record& record) {
  const auto& v = task.request.profile_mm;
  sim::ProfileLine line;
  line.from_W = from_mm(1) * Vec3(v[0], v[1], v[2]);
  line.to_W = from_mm(1) * Vec3(v[3], v[4], v[5]);
  line.probe_W = Vec3(task.request.probe[0], task.request.probe[1], task.request.probe[2]);
  const sim::SurfaceProfile profile = sim::measure_profile(workpiece, task.intended.get(), line);
  const sim::Roughness roughness = sim::roughness(profile.heights, profile.pitch);
  record.surface->ra_um = to_um(roughness.ra);
  record.surface->rz_um = to_um(roughness.rz);
  record.profile_note = fmt::format("cut-off {:g} mm, {} sampling length{}{}", to_mm(roughness.cutoff),
                                    roughness.sampling_lengths, roughness.sampling_lengths == 1 ? "" : "s",
                                    roughness.cutoff_is_standard ? "" : "; ISO 4288 asks for a longer line");
  const std::size_t stride = profile.heights.size() / kChartPoints + 1;
  for (std::size_t i = 0; i < profile.heights.size(); i += stride)
    record.profile.push_back({to_mm(profile.pitch * static_cast<double>(i)), to_um(profile.heights[i])});
}

void measure_deviation(const SurfaceTask& task, const sim::Workpiece& workpiece, Record& record) {
  const auto samples = sim::sample_deviation(workpiece.beads(), *task.intended);
  const sim::SurfaceDeviation deviation = sim::summarise(samples);
  if (deviation.covered > 0) record.surface->deviation_p95_um = to_um(deviation.p95);
  record.deviation_note = fmt::format(
      "of the intended surface {:.1f} % has material within 1 mm; there the print lies {:+.0f} um off on the "
      "mean, "
      "{:.0f} um at the median, {:.0f} um at 95 %, {:.0f} um at most",
      100 * deviation.coverage, to_um(deviation.mean), to_um(deviation.p50), to_um(deviation.p95),
      to_um(deviation.largest));
}

/// Neither shorter nor infinite nor not a number.
bool is_length(const Vec3& v, double least) { return v.norm() >= least && std::isfinite(v.norm()); }

Finding not_measured(const std::string& why) {
  Finding f;
  f.kind = "unreachable";
  f.severity = Severity::warning;
  f.unit = "1";
  f.message = "the surface was not measured: " + why;
  return f;
}

}  // namespace

SurfaceTask prepare_surface(const SurfaceRequest& request) {
  SurfaceTask task{nullptr, request};
  const std::string& file = request.as_printed;
  if (!file.empty() && !file.ends_with(".stl") && !file.ends_with(".ply"))
    throw InputError("--as-printed " + file + ": ends in neither .stl nor .ply");
  if (!file.empty()) check_writable(file);
  if (!request.intended.empty()) task.intended = geometry::read_stl(machine::find_fixture(request.intended));
  const auto& v = request.profile_mm;
  if (!v.empty() && (v.size() != 6 || !is_length(Vec3(v[3] - v[0], v[4] - v[1], v[5] - v[2]), 1e-3)))
    throw InputError("--profile: six numbers that tell two points apart, x,y,z,x,y,z in mm");
  if (request.probe.size() != 3 ||
      !is_length(Vec3(request.probe[0], request.probe[1], request.probe[2]), 1e-9))
    throw InputError("--probe: three numbers that are a direction, x,y,z");
  return task;
}

void study_surface(const SurfaceTask& task, const sim::Workpiece& workpiece, Record& record) {
  if (!task.wanted()) return;
  record.surface = SurfaceFigures{};
  try {
    if (!task.request.profile_mm.empty()) measure_line(task, workpiece, record);
    if (task.intended) measure_deviation(task, workpiece, record);
  } catch (const InputError& error) {
    record.findings.push_back(not_measured(error.what()));
  }
  if (task.request.as_printed.empty()) return;
  sim::AsPrintedSettings settings;
  settings.intended = task.intended.get();
  sim::write_as_printed(task.request.as_printed, workpiece.beads(), settings);
}

}  // namespace understudy::rehearsal
