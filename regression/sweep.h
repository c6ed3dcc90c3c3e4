// The same print on many as-built machines: how often is it safe, and how far off do they start?
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/progress.h"
#include "regression/metrics.h"
#include "rehearsal/request/request.h"

namespace understudy::regression {

/// One machine's answer, without the bulk of its record.
struct SweepRow {
  std::uint64_t seed = 0;
  bool go = false;
  Metrics metrics;                ///< of this rehearsal
  double open_loop_start_mm = 0;  ///< true gap at the start without gap control
  double start_mm = 0;            ///< with the request's gap control; 0 when nothing was printed
  bool printed = false;
  double approach_min_mm = 0;      ///< smallest true gap before extrusion begins; <= 0 is a touch
  bool open_loop_touched = false;  ///< without gap control, from the first move to the last
  bool touched = false;            ///< with it, from the first move to the last
  double in_band_fraction = 0;
  double open_loop_in_band_fraction = 0;
};

/// Rehearses with seeds first..first+count-1 on `threads` threads. Rows are ordered by seed and do not depend
/// on the number of threads. Throws what rehearse() throws, for the smallest seed that failed.
/// `journal`: file that keeps the rows until all are there (core/file/run_journal.h), but for their metrics;
/// empty: none.
std::vector<SweepRow> sweep(const rehearsal::RehearsalRequest& request, std::uint64_t first, int count,
                            int threads, const Progress& progress = {}, const std::string& journal = {});

/// The table of a sweep, for people: distribution of the start gap with and without gap control, touches.
std::string sweep_table(const std::vector<SweepRow>& rows, double band_min_mm, double band_max_mm);
/// "verdict go: 12 of 200", the last line of the table.
std::string sweep_verdict(const std::vector<SweepRow>& rows);
/// One line a machine.
std::string sweep_csv(const std::vector<SweepRow>& rows);

}  // namespace understudy::regression
