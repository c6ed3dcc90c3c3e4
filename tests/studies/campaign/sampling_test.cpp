#include "studies/campaign/sampling.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

namespace understudy::studies {
namespace {

TEST(Sampling, AGridHasEveryCombinationOnce) {
  CampaignParameter a, b;
  a.values = {"1", "2", "3"};
  b.values = {"x", "y"};
  const auto points = grid_points({a, b});
  ASSERT_EQ(points.size(), 6u);
  EXPECT_EQ(points[0], (ParameterValues{"1", "x"}));
  EXPECT_EQ(points[1], (ParameterValues{"1", "y"}));
  EXPECT_EQ(points[5], (ParameterValues{"3", "y"}));
  EXPECT_EQ(grid_points({}).size(), 1u);
}

TEST(Sampling, EverySliceOfALatinHypercubeHoldsOnePoint) {
  constexpr std::size_t kCount = 37;
  const auto points = latin_hypercube(kCount, 4);
  for (std::size_t d = 0; d < 4; ++d) {
    std::set<std::size_t> slices;
    for (const auto& point : points) slices.insert(static_cast<std::size_t>(point[d] * kCount));
    EXPECT_EQ(slices.size(), kCount) << d;
    EXPECT_EQ(*slices.rbegin(), kCount - 1) << d;
  }
}

TEST(Sampling, SobolPointsAreTheFirstOfTheSequence) {
  // Joe and Kuo 2008: after the origin, 1/2; 3/4, 1/4; 1/4, 3/4.
  const auto points = sobol_points(3, 2);
  EXPECT_EQ(points[0], (std::vector<double>{0.5, 0.5}));
  EXPECT_EQ(points[1], (std::vector<double>{0.75, 0.25}));
  EXPECT_EQ(points[2], (std::vector<double>{0.25, 0.75}));
}

TEST(Sampling, SobolPointsIntegrateBetterThanRandomOnes) {
  // The mean of prod (|4 x - 2| + 1/2) / 1.5 ... over the cube is 1; 1024 random points miss it by some 2 %.
  const auto points = sobol_points(1023, 3);
  double sum = 0;
  for (const auto& point : points) {
    double product = 1;
    for (const double x : point) product *= (std::abs(4 * x - 2) + 0.5) / 1.5;
    sum += product;
  }
  EXPECT_NEAR(sum / 1023, 1, 5e-3);
}

TEST(Sampling, ScalesRunFromEndToEnd) {
  CampaignParameter parameter;
  parameter.from = 1, parameter.to = 100;
  EXPECT_DOUBLE_EQ(scaled(parameter, 0), 1);
  EXPECT_DOUBLE_EQ(scaled(parameter, 0.5), 50.5);
  parameter.scale = ParameterScale::logarithmic;
  EXPECT_DOUBLE_EQ(scaled(parameter, 0.5), 10);
  EXPECT_DOUBLE_EQ(scaled(parameter, 1), 100);
}

TEST(Sampling, ValuesAreTextThatReadsBack) {
  EXPECT_EQ(value_text(0.13), "0.13");
  EXPECT_EQ(value_text(100), "100");
  EXPECT_NEAR(std::stod(value_text(M_PI)), M_PI, 1e-8);
}

}  // namespace
}  // namespace understudy::studies
