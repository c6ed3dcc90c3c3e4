#include "calibration/rows/held_columns.h"

#include <algorithm>

#include <gmock/gmock.h>

#include "tests/calibration/rows/drawn_rows.h"

namespace understudy::calibration {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

std::vector<std::string> held(const kinematics::Chain& chain, bool base_free, bool tool_free) {
  const auto names = chain_parameter_names(chain);
  std::vector<std::string> list;
  for (const Eigen::Index column : held_columns(chain, base_free, tool_free))
    if (const std::string& name = names[static_cast<std::size_t>(column)];
        std::find(list.begin(), list.end(), name) == list.end())
      list.push_back(name);
  return list;
}

std::ptrdiff_t of_axis(const std::vector<std::string>& names, const std::string& axis) {
  return std::count_if(names.begin(), names.end(),
                       [&](const std::string& name) { return name.starts_with(axis + " "); });
}

// As many as Everett (1987) says are left: 4 of an axis, less the 6 of base and tool each.
TEST(HeldColumns, AreTheBaseTheLastZeroAndOneNumberOfEachLine) {
  const kinematics::Chain chain = DrawnRows({}, 1).nominal.chain()->chain;
  const auto names = held(chain, true, true);
  EXPECT_EQ(names.size(), 5u * 6u - (4u * 6u - 6u));
  EXPECT_EQ(of_axis(names, "j1"), 5);
  EXPECT_EQ(of_axis(names, "j2"), 2);  // azimuth and height
  for (const char* axis : {"j3", "j4", "j5"}) EXPECT_EQ(of_axis(names, axis), 1) << axis;
  for (const char* axis : {"j2", "j3", "j4", "j5"})
    EXPECT_THAT(names, Not(Contains(axis + std::string(" zero"))));
  EXPECT_THAT(names, Contains("j6 zero"));
}

TEST(HeldColumns, WithAMeasuredToolTheLastZeroIsToldAndATurnOfTheMountIsNot) {
  const kinematics::Chain chain = DrawnRows({}, 1).nominal.chain()->chain;
  const auto names = held(chain, false, false);
  EXPECT_EQ(of_axis(names, "j1"), 0);
  EXPECT_THAT(names, Not(Contains("j6 zero")));
  EXPECT_THAT(names, Contains(HasSubstr("tool turn")));
}

// A rail that never moves is a part of the frame: the base is the next axis.
TEST(HeldColumns, AnAxisThatStandsIsNotTold) {
  const kinematics::Chain chain = DrawnRows({}, 1).nominal.chain()->chain;
  const StationaryAxes stands{0.3, {}, {}, {}, {}, {}};
  const auto names = chain_parameter_names(chain);
  std::vector<std::string> list;
  for (const Eigen::Index column : held_columns(chain, true, true, stands))
    list.push_back(names[static_cast<std::size_t>(column)]);
  EXPECT_EQ(of_axis(list, "j1"), 5);
  EXPECT_EQ(of_axis(list, "j2"), 5);
  EXPECT_EQ(of_axis(list, "j3"), 1);  // parallel to j2: a height along both moves neither,
  EXPECT_EQ(of_axis(list, "j4"), 2);  // but this one
  EXPECT_THAT(list, Not(Contains("j3 zero")));
}

}  // namespace
}  // namespace understudy::calibration
