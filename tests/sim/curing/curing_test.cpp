#include "sim/curing/curing.h"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "core/units.h"

namespace understudy::sim {
namespace {

constexpr double kFilament = 1e-6;  // [m^2]

/// 5 mW through 0.5 mm into resin of 0.1 mm and 10 mJ/cm2.
machine::Cure resin() { return {0.5e-3, 5e-3, 0.1e-3, 100}; }

class Kept : public Observer {
 public:
  void observe(const Snapshot& snapshot) override { all.push_back(snapshot); }
  std::vector<Snapshot> all;
};

class Curing : public testing::Test {
 protected:
  /// 0.1 s later, `way` farther along x; the light on or off.
  void go(double way, bool light) {
    now_.time += 0.1;
    now_.X_WT.translation().x() += way;
    if (light) now_.filament += 1e-6;
    curing_.observe(now_);
  }
  double cured() const { return kept_.all.back().filament * kFilament; }

  double gap_ = std::numeric_limits<double>::infinity();
  Kept kept_;
  CuringObserver curing_{resin(), kFilament, [this] { return gap_; }, kept_};
  Snapshot now_;
};

TEST_F(Curing, LeavesTheSectionOfALineTimesItsWayWhateverWasPlanned) {
  go(0, false);
  for (int i = 0; i < 10; ++i) go(0.2e-3, true);  // 2 mm/s
  EXPECT_NEAR(cured(), resin().area(2e-3, 1) * 2e-3, 1e-18);
  EXPECT_NEAR(curing_.depth(), resin().depth(2e-3), 1e-12);
  EXPECT_EQ(kept_.all.size(), 11u);
  EXPECT_EQ(kept_.all.back().X_WT.translation(), now_.X_WT.translation());
}

TEST_F(Curing, MakesASlowLineThickerAndADarkOneNone) {
  go(0, false);
  go(0.1e-3, true);
  const double slow = cured();
  go(0.1e-3, false);
  EXPECT_EQ(cured(), slow);
  EXPECT_GT(slow / 0.1e-3, resin().area(2e-3, 1));
}

TEST_F(Curing, CuresNoDeeperThanTheGap) {
  gap_ = 0.05e-3;
  go(0, false);
  go(0.2e-3, true);
  // All but the edges of the line reach deeper: a band of the gap's height.
  EXPECT_LT(cured(), gap_ * resin().width(2e-3) * 0.2e-3);
  EXPECT_GT(cured(), 0.9 * gap_ * resin().width(2e-3) * 0.2e-3);
}

TEST_F(Curing, TakesAStandstillForVerySlow) {
  go(0, false);
  go(0, true);
  EXPECT_EQ(cured(), 0);
  EXPECT_NEAR(curing_.depth(), resin().depth(CuringObserver::kSlowest), 1e-12);
}

}  // namespace
}  // namespace understudy::sim
