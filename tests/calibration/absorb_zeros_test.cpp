#include "calibration/absorb_zeros.h"

#include <gtest/gtest.h>

#include "core/random.h"
#include "machine/description.h"

namespace understudy::calibration {
namespace {

TEST(AbsorbZeros, LeavesThePosesWhereTheyWere) {
  ChainParameters machine{machine::load_machine("arm").chain().kinematics.chain, {}};
  machine.zero = {0.02, -0.03, 0.05, 0.01, -0.02, 0.04};
  const kinematics::Chain chain = absorb_zeros(machine);
  Random random(1, "zeros");
  for (int k = 0; k < 20; ++k) {
    std::vector<double> q;
    for (int i = 0; i < 6; ++i) q.push_back(random.uniform(-1, 1));
    EXPECT_TRUE(kinematics::forward(chain, q).isApprox(forward(machine, q), 1e-13));  // rounding
  }
}

}  // namespace
}  // namespace understudy::calibration
