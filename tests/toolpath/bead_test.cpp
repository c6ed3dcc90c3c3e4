#include "toolpath/bead.h"

#include <numbers>

#include <gtest/gtest.h>

namespace understudy::toolpath {
namespace {

TEST(Bead, AreaIsARectangleAndTwoHalfDiscs) {
  EXPECT_DOUBLE_EQ(bead_area(0.5e-3, 0.2e-3), 0.3e-3 * 0.2e-3 + std::numbers::pi * 0.1e-3 * 0.1e-3);
}

TEST(Bead, AsWideAsHighItIsARoundStrand) {
  EXPECT_DOUBLE_EQ(bead_area(0.4e-3, 0.4e-3), strand_area(0.4e-3));
  EXPECT_DOUBLE_EQ(strand_area(1.75e-3), std::numbers::pi * 0.875e-3 * 0.875e-3);
}

}  // namespace
}  // namespace understudy::toolpath
