#include "rehearsal/observers/trace_observer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace understudy::rehearsal {
namespace {

constexpr int kSnapshots = 10'000;

machine::MachineDescription printer() {
  machine::MachineDescription machine;
  machine.tool.filament_diameter = 1.75e-3;
  machine.gap.accepted_max = 0.2e-3;
  return machine;
}

// The tip is off the command by a ramp up to 1 mm along x.
sim::Snapshot at(int k) {
  const double t = static_cast<double>(k) / kSnapshots;
  sim::Snapshot s;
  s.time = t;
  s.filament = 1e-3 * t;
  s.X_WT_commanded.translation() = Vec3(t, 0, 0.15e-3);
  s.X_WT.translation() = Vec3(t + 1e-3 * t, 0, 0.15e-3);
  return s;
}

struct Traced {
  explicit Traced(std::size_t capacity)
      : deposition(printer(), std::make_shared<sim::Workpiece>(nullptr)), trace(deposition, capacity) {
    for (int k = 0; k <= kSnapshots; ++k) {
      deposition.observe(at(k));
      trace.observe(at(k));
    }
  }
  sim::DepositionObserver deposition;
  TraceObserver trace;
};

TEST(TraceObserver, AShortRunIsKeptWhole) {
  Traced run(kSnapshots + 1);
  EXPECT_EQ(run.trace.stride(), 1);
  EXPECT_EQ(run.trace.take().size(), static_cast<std::size_t>(kSnapshots + 1));
}

TEST(TraceObserver, ALongRunIsThinnedEvenlyAndEndsAtItsEnd) {
  Traced run(1000);
  EXPECT_EQ(run.trace.stride(), 16);
  const auto trace = run.trace.take();
  EXPECT_LE(trace.size(), 1001u);
  EXPECT_GE(trace.size(), 500u);
  EXPECT_EQ(trace.front().time, 0);
  EXPECT_EQ(trace.back().time, 1);
  for (std::size_t i = 1; i + 1 < trace.size(); ++i)
    EXPECT_NEAR(trace[i].time - trace[i - 1].time, 16.0 / kSnapshots, 1e-12);
}

// Of a ramp to 1 mm in 10 000 steps: RMS 1/sqrt(3), the largest 1.
void expect_figures_of_the_ramp(Traced& run, double p95_um) {
  const auto accuracy = run.trace.accuracy();
  ASSERT_TRUE(accuracy.has_value());
  EXPECT_NEAR(accuracy->tip_rms_um, 1000 / std::sqrt(3), 0.2);
  EXPECT_NEAR(accuracy->tip_p95_um, p95_um, 0.01);  // a tenth of a step
  EXPECT_NEAR(accuracy->tip_max_um, 1000, 1e-6);
}

// The steps 1, 2, ... 10 000: 9500 of them are smaller than step 9501.
TEST(TraceObserver, FiguresAreThoseOfAllSnapshots) {
  Traced run(kSnapshots / TraceObserver::kErrorsPerPoint);
  expect_figures_of_the_ramp(run, 950.1);
}

// 2000 are kept at most, so that one of eight is: the steps 1, 9, 17, ... 9993. Of these 1250, 1187 are
// smaller than step 9497.
TEST(TraceObserver, ThePercentileOfALongRunIsThatOfOneSnapshotOfEight) {
  Traced run(100);
  expect_figures_of_the_ramp(run, 949.7);
}

}  // namespace
}  // namespace understudy::rehearsal
