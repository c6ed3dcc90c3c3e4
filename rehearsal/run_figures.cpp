#include "rehearsal/run_figures.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/assert.h"
#include "core/quantile.h"
#include "core/units.h"

namespace understudy::rehearsal {
namespace {

/// Nothing where no gap exists: nothing was printed, or somewhere nothing lies below the nozzle.
std::optional<GapFigures> gap_of(const TwinRun& run, const TwinRun* without,
                                 const machine::MachineDescription& machine) {
  const auto& laid = run.deposition;
  if (!(laid.length > 0) || !std::isfinite(laid.gap_max) || !std::isfinite(laid.start_gap))
    return std::nullopt;
  GapFigures gap;
  gap.commanded_mm = to_mm(machine.gap.aim);
  if (without && without->deposition.length > 0 && std::isfinite(without->deposition.start_gap))
    gap.open_loop_start_mm = to_mm(without->deposition.start_gap);
  gap.start_mm = to_mm(laid.start_gap);
  gap.path_min_mm = to_mm(laid.gap_min);
  gap.path_mean_mm = to_mm(laid.gap_mean);
  gap.path_max_mm = to_mm(laid.gap_max);
  gap.in_band_fraction = laid.in_band_fraction;
  gap.frames = static_cast<int>(run.frames.size());
  return gap;
}

/// Volume of bead, told as length of the filament it came from.
double as_filament_mm(double volume, const machine::MachineDescription& machine) {
  if (!machine.tool.prints()) return 0;
  const double d = machine.tool.filament_diameter;
  return to_mm(volume / (0.25 * std::numbers::pi * d * d));
}

void fill_strands(const std::vector<sim::AirStrand>& strands, Record& record) {
  SagFigures sag;
  sag.strands = static_cast<int>(strands.size());
  for (const sim::AirStrand& strand : strands) {
    sag.max_um = std::max(sag.max_um, to_um(strand.sag));
    sag.unsupported_mm += to_mm(strand.length);
    const double diameter_mm = to_mm(strand.diameter * std::sqrt(1 + strand.overfeed));
    const bool first = record.strands.empty();
    sag.diameter_min_mm = first ? diameter_mm : std::min(sag.diameter_min_mm, diameter_mm);
    sag.diameter_max_mm = std::max(sag.diameter_max_mm, diameter_mm);
    record.strands.push_back({strand.line, strand.time, to_mm(strand.length), to_mm(strand.diameter),
                              to_mm(strand.speed), to_um(strand.sag), strand.solid_after, strand.duration,
                              strand.held_at_end, strand.solved, strand.small});
  }
  std::stable_sort(record.strands.begin(), record.strands.end(),
                   [](const StrandRow& a, const StrandRow& b) { return a.sag_um > b.sag_um; });
  record.sag = sag;
}

}  // namespace

PrintFigures print_figures(const TwinRun& run, const machine::MachineDescription& truth) {
  const sim::DepositionSummary& laid = run.deposition;
  double spanning_volume = 0;
  for (const sim::UnsupportedStretch& stretch : run.loose)
    if (sim::hangs_in_air(stretch) || sim::spans_a_groove(stretch)) spanning_volume += stretch.volume;
  PrintFigures print;
  print.duration_s = run.result.duration;
  print.moves = run.result.moves;
  print.extruded_mm = as_filament_mm(laid.extruded_volume, truth);
  print.printed_mm = as_filament_mm(laid.laid_volume - laid.standstill_volume, truth);
  print.purged_mm = as_filament_mm(laid.standstill_volume, truth);
  print.missing_mm = std::max(0.0, print.extruded_mm - print.printed_mm - print.purged_mm);
  print.primed_mm = to_mm(run.result.primed);
  print.deposited_mm = as_filament_mm(laid.deposited_volume, truth);
  print.spanning_mm = as_filament_mm(spanning_volume, truth);
  print.travel_mm = to_mm(run.result.travel);
  if (run.fill) print.fill_factor = run.fill->factor;
  return print;
}

void fill_figures(const TwinRun& run, const TwinRun* without, const machine::MachineDescription& truth,
                  Record& record) {
  record.print = print_figures(run, truth);
  record.collision = run.collision;
  record.engine = run.engine;
  record.timing = run.timing;
  record.accuracy = run.accuracy;
  const auto& open_loop = without ? without->accuracy : run.accuracy;
  if (record.accuracy && open_loop) record.accuracy->open_loop_tip_max_um = open_loop->tip_max_um;
  if (truth.tool.prints()) fill_strands(run.strands, record);
  record.gap = gap_of(run, without, truth);
}

void fill_belief(const std::vector<TracePoint>& trace, const std::vector<GapBelief>& beliefs,
                 GapFigures& gap) {
  constexpr double kSigmas = 3;
  UNDERSTUDY_ASSERT(trace.size() == beliefs.size(), "each point of the trace has its belief");
  double path = 0, stated = 0, inside = 0, believed = 0;
  std::vector<double> sigmas;
  for (std::size_t i = 1; i < trace.size(); ++i) {
    const double way = trace[i].path - trace[i - 1].path;
    if (!trace[i].extruding || !std::isfinite(trace[i].gap)) continue;
    path += way;
    const auto& [held, sigma] = beliefs[i];
    if (!std::isfinite(sigma)) continue;
    stated += way;
    believed += way * held;
    if (std::abs(trace[i].gap - held) <= kSigmas * sigma) inside += way;
    sigmas.push_back(sigma);
  }
  if (!(stated > 0)) return;
  gap.believed_mean_mm = to_mm(believed / stated);
  gap.stated_sigma_um = to_um(quantile(sigmas, 0.5));
  gap.stated_path_fraction = stated / path;
  gap.inside_stated_3_sigma_fraction = inside / stated;
}

}  // namespace understudy::rehearsal
