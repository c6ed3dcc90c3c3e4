#include "regression/sweep.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/file/run_journal.h"
#include "core/parallel.h"
#include "core/quantile.h"
#include "core/units.h"
#include "rehearsal/rehearse.h"
#include "rehearsal/request/input_digest.h"

namespace understudy::regression {
namespace {

using rehearsal::Finding;
using rehearsal::Record;
using rehearsal::TracePoint;

bool touches(const std::vector<TracePoint>& trace) {
  return std::any_of(trace.begin(), trace.end(), [](const TracePoint& p) { return p.gap <= 0; });
}

double in_band(const std::vector<TracePoint>& trace, double low_mm, double high_mm) {
  int inside = 0, all = 0;
  for (const TracePoint& p : trace) {
    if (!p.extruding) continue;
    ++all;
    if (to_mm(p.gap) >= low_mm && to_mm(p.gap) <= high_mm) ++inside;
  }
  return all ? static_cast<double>(inside) / all : 0;
}

SweepRow row_of(const Record& record, std::uint64_t seed) {
  SweepRow row;
  row.seed = seed;
  row.go = record.go;
  row.metrics = metrics_of(record);
  const auto collides = [](const Finding& f) { return f.kind == "collision"; };
  row.touched =
      touches(record.trace) || std::any_of(record.findings.begin(), record.findings.end(), collides);
  row.approach_min_mm = HUGE_VAL;
  for (const TracePoint& p : record.trace) {
    if (p.extruding) break;
    row.approach_min_mm = std::min(row.approach_min_mm, to_mm(p.gap));
  }
  const auto& open_loop = record.trace_without_gap_control;
  row.open_loop_touched = touches(open_loop);
  row.open_loop_in_band_fraction = in_band(open_loop, record.gap_accepted_min_mm, record.gap_accepted_max_mm);
  const auto first =
      std::find_if(open_loop.begin(), open_loop.end(), [](const TracePoint& p) { return p.extruding; });
  if (first != open_loop.end()) row.open_loop_start_mm = to_mm(first->gap);
  if (record.gap) {
    row.printed = true;
    row.start_mm = record.gap->start_mm;
    row.in_band_fraction = record.gap->in_band_fraction;
  }
  return row;
}

RunJournal::Answer numbers_of(const SweepRow& row) {
  const auto flag = [](bool is) { return is ? 1.0 : 0.0; };
  return {flag(row.go),      row.open_loop_start_mm, row.start_mm,
          flag(row.printed), row.approach_min_mm,    flag(row.open_loop_touched),
          flag(row.touched), row.in_band_fraction,   row.open_loop_in_band_fraction};
}

SweepRow row_in(const RunJournal::Answer& numbers, std::uint64_t seed) {
  SweepRow row;
  row.seed = seed;
  row.go = numbers.at(0) != 0;
  row.open_loop_start_mm = numbers.at(1);
  row.start_mm = numbers.at(2);
  row.printed = numbers.at(3) != 0;
  row.approach_min_mm = numbers.at(4);
  row.open_loop_touched = numbers.at(5) != 0;
  row.touched = numbers.at(6) != 0;
  row.in_band_fraction = numbers.at(7);
  row.open_loop_in_band_fraction = numbers.at(8);
  return row;
}

struct Distribution {
  std::vector<double> values;
  int touched = 0;
  std::vector<double> in_band;
};

std::string line_of(const std::string& name, const Distribution& d, double low, double high) {
  const auto n = static_cast<double>(d.values.size());
  const auto inside =
      std::count_if(d.values.begin(), d.values.end(), [&](double v) { return v >= low && v <= high; });
  return fmt::format("{:<22} {:>7.1f} {:>8.3f} {:>8.3f} {:>8.3f} {:>8.3f} {:>8.3f} {:>9d} {:>13.1f}\n", name,
                     100 * static_cast<double>(inside) / n, quantile(d.values, 0), quantile(d.values, 0.05),
                     quantile(d.values, 0.5), quantile(d.values, 0.95), quantile(d.values, 1), d.touched,
                     100 * quantile(d.in_band, 0.5));
}

}  // namespace

std::vector<SweepRow> sweep(const rehearsal::RehearsalRequest& request, std::uint64_t first, int count,
                            int threads, const Progress& progress, const std::string& journal_file) {
  std::vector<SweepRow> rows(static_cast<std::size_t>(count));
  const auto machine = [&](std::size_t i) {
    rehearsal::RehearsalRequest one = request;
    one.seed = first + i;
    one.keep_scene = false;
    return one;
  };
  const auto rehearse_one = [&](std::size_t i) { return row_of(rehearsal::rehearse(machine(i)), first + i); };
  RunJournal journal(journal_file,
                     journal_file.empty() ? "" : "sweep of " + rehearsal::inputs_sha256(machine(0)));
  if (!journal_file.empty()) journal.confirm(numbers_of(rehearse_one(0)));
  const auto run = [&](std::size_t i) {
    const auto known = journal.find(i);
    rows[i] = known ? row_in(*known, first + i) : rehearse_one(i);
    if (!known) journal.add(i, numbers_of(rows[i]));
  };
  in_parallel(rows.size(), threads, run, [&](std::size_t, std::size_t done) {
    if (progress) progress(static_cast<double>(done) / count, fmt::format("machine {} of {}", done, count));
  });
  journal.remove();
  return rows;
}

std::string sweep_table(const std::vector<SweepRow>& rows, double low, double high) {
  Distribution open_loop, controlled;
  int stopped = 0, approach_touches = 0;
  for (const SweepRow& row : rows) {
    open_loop.values.push_back(row.open_loop_start_mm);
    open_loop.in_band.push_back(row.open_loop_in_band_fraction);
    open_loop.touched += row.open_loop_touched;
    if (!row.printed) {
      ++stopped;
      continue;
    }
    controlled.values.push_back(row.start_mm);
    controlled.in_band.push_back(row.in_band_fraction);
    controlled.touched += row.touched;
    approach_touches += row.approach_min_mm <= 0;
  }
  std::string table =
      fmt::format("{} as-built machines, start gap in mm (band {:.2f}..{:.2f} mm)\n", rows.size(), low, high);
  table +=
      "                       in band  minimum      5 %   median     95 %  maximum  touch on  path in band\n";
  table +=
      "                             %                                               the path  % (median)\n";
  if (!controlled.values.empty()) {
    table += line_of("without gap control", open_loop, low, high);
    table += line_of("with gap control", controlled, low, high);
  }
  table += fmt::format("touches before the print begins, with gap control: {}\n", approach_touches);
  table += fmt::format("stopped before anything was printed: {}\n", stopped);
  return table + sweep_verdict(rows);
}

std::string sweep_verdict(const std::vector<SweepRow>& rows) {
  return fmt::format("verdict go: {} of {}\n",
                     std::count_if(rows.begin(), rows.end(), [](const SweepRow& r) { return r.go; }),
                     rows.size());
}

std::string sweep_csv(const std::vector<SweepRow>& rows) {
  std::string csv =
      "seed,go,printed,open_loop_start_mm,start_mm,approach_min_mm,open_loop_touched,touched,"
      "open_loop_in_band_fraction,in_band_fraction\n";
  for (const SweepRow& r : rows)
    csv += fmt::format("{},{:d},{:d},{:.6f},{:.6f},{:.6f},{:d},{:d},{:.6f},{:.6f}\n", r.seed, r.go, r.printed,
                       r.open_loop_start_mm, r.start_mm, r.approach_min_mm, r.open_loop_touched, r.touched,
                       r.open_loop_in_band_fraction, r.in_band_fraction);
  return csv;
}

}  // namespace understudy::regression
