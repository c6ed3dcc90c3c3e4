#include "report/page/pack.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/random.h"
#include "tests/report/page/unpack.h"

namespace understudy::report {
namespace {

TEST(Pack, IntegersComeBackAsTheyWere) {
  Random random(5, "packed integers");
  std::vector<std::int64_t> values{0, -1, 1, 63, 64, -64, -65, kNone, 0, kNone, -kNone};
  for (int i = 0; i < 5000; ++i)
    values.push_back(static_cast<std::int64_t>(std::pow(2.0, random.uniform(0, 39)) * random.normal()));
  EXPECT_EQ(integers(pack_integers(values)), values);
  EXPECT_TRUE(integers(pack_integers({})).empty());
}

TEST(Pack, ValuesAreWholeUnitsAndWhatIsNotFiniteIsNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN(),
               infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(integers(pack_values({1.2346, -0.0004, nan, infinity, 1e300}, 1e-3)),
            (std::vector<std::int64_t>{1235, 0, kNone, kNone, kNone}));
}

TEST(Pack, TextComesBackAndSmoothColumnsAreSmall) {
  EXPECT_EQ(unpacked(pack_text("G1 X1 ; </script>")), "G1 X1 ; </script>");
  std::vector<double> ramp;
  for (int i = 0; i < 10'000; ++i) ramp.push_back(1e-3 * i);
  EXPECT_LT(pack_values(ramp, 1e-3).size(), 200u);
}

}  // namespace
}  // namespace understudy::report
