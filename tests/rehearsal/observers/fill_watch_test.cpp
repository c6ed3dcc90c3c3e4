#include "rehearsal/observers/fill_watch.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sim/deposition/bead_section.h"

namespace understudy::rehearsal {
namespace {

constexpr double kHeight = 0.2e-3;

/// Lines along x, 30 mm long, side by side on the table, each in elements of 2 mm.
class Lines {
 public:
  explicit Lines(std::vector<float> fed)
      : workpiece_(std::make_shared<sim::Workpiece>(nullptr)),
        watch_(workpiece_, machine(), std::move(fed)) {}

  /// `area`: as laid; the lag may have left less than what was fed.
  void add(double y, double area) {
    const std::size_t before = workpiece_->beads().size();
    for (int i = 0; i < 15; ++i) {
      sim::LaidBead laid;
      laid.from_W = Vec3(2e-3 * i, y, 0);
      laid.to_W = Vec3(2e-3 * (i + 1), y, 0);
      laid.length = 2e-3;
      laid.height = kHeight;
      laid.width = sim::bead_width(area, kHeight);
      laid.line = static_cast<int>(before) + i;
      sim::Bead bead;
      bead.from_W = {static_cast<float>(laid.from_W.x()), static_cast<float>(y),
                     static_cast<float>(kHeight / 2)};
      bead.to_W = {static_cast<float>(laid.to_W.x()), static_cast<float>(y), static_cast<float>(kHeight / 2)};
      bead.width = static_cast<float>(laid.width);
      bead.height = static_cast<float>(kHeight);
      bead.line = laid.line;
      workpiece_->add(bead);
      watch_.add(laid, before);
    }
  }
  std::optional<FillFigures> figures() const { return watch_.figures(); }

 private:
  static machine::MachineDescription machine() {
    machine::MachineDescription m;
    m.tool.nozzle_diameter = 0.4e-3;
    return m;
  }
  std::shared_ptr<sim::Workpiece> workpiece_;
  FillWatch watch_;
};

// PrusaSlicer sets lines of 0.45 by 0.2 mm 0.45 - 0.2 (1 - pi/4) = 0.4071 mm apart: the space is filled.
constexpr double kSpacing = 0.4071e-3, kArea = 0.4071e-3 * kHeight;

std::vector<float> all_fed(double area) { return std::vector<float>(400, static_cast<float>(area)); }

FillFigures of(double fed, double laid) {
  Lines lines(all_fed(fed * kArea));
  for (int i = 0; i < 8; ++i) lines.add(i * kSpacing, laid * kArea);
  const auto figures = lines.figures();
  EXPECT_TRUE(figures);
  return figures.value_or(FillFigures{});
}

TEST(FillWatch, LinesAsASlicerSetsThemFillTheirSpace) { EXPECT_NEAR(of(1, 1).factor, 1, 2e-3); }

TEST(FillWatch, ThreeFifthsOfTheFlowFillThreeFifths) {
  EXPECT_NEAR(of(0.6, 0.6).factor, 0.6, 2e-3);
  EXPECT_NEAR(of(1.3, 1.3).factor, 1.3, 2e-3);
}

TEST(FillWatch, WhatIsFedCountsWhereTheLagMovesIt) {
  const FillFigures figures = of(1, 0.75);
  EXPECT_NEAR(figures.factor, 1, 2e-3);
  EXPECT_NEAR(figures.laid, 0.75, 2e-3);
}

TEST(FillWatch, LinesFartherApartAreNoNeighbours) {
  Lines lines(all_fed(kArea));
  for (int i = 0; i < 20; ++i) lines.add(i * 0.65e-3, kArea);
  EXPECT_FALSE(lines.figures());
}

TEST(FillWatch, ShellsSpeakForAPartWhoseInfillIsThin) {
  std::vector<float> fed = all_fed(kArea);
  std::fill(fed.begin() + 16 * 15, fed.end(), static_cast<float>(0.8 * kArea));
  Lines lines(fed);
  for (int i = 0; i < 16; ++i) lines.add(i * kSpacing, kArea);
  for (int i = 1; i < 7; ++i) lines.add(16 * kSpacing + i * 0.51e-3, 0.8 * kArea);  // 64 % filled
  ASSERT_TRUE(lines.figures());
  EXPECT_NEAR(lines.figures()->factor, 1, 2e-3);
}

TEST(FillWatch, AFewMillimetresSayNothing) {
  Lines lines(all_fed(kArea));
  lines.add(0, kArea);
  lines.add(kSpacing, kArea);
  EXPECT_FALSE(lines.figures());
}

}  // namespace
}  // namespace understudy::rehearsal
