#include "rehearsal/axis_columns.h"

#include <gtest/gtest.h>

#include "machine/description.h"

namespace understudy::rehearsal {
namespace {

std::vector<std::string> names_of(const std::string& machine) {
  std::vector<std::string> names;
  for (const AxisColumn& column : axis_columns(*machine::load_machine(machine).make_mechanism()))
    names.push_back(column.name);
  return names;
}

TEST(AxisColumns, AreTheAxesWithTheirUnitsInTheMachinesOrder) {
  EXPECT_EQ(names_of("hexapod"),
            (std::vector<std::string>{"l1_mm", "l2_mm", "l3_mm", "l4_mm", "l5_mm", "l6_mm"}));
  EXPECT_EQ(names_of("five-axis"),
            (std::vector<std::string>{"axis_x_mm", "axis_y_mm", "axis_z_mm", "b_deg", "c_deg"}));
}

TEST(AxisColumns, AnEndlessAxisHasNoLimits) {
  const auto columns = axis_columns(*machine::load_machine("five-axis").make_mechanism());
  EXPECT_TRUE(columns[0].min && columns[0].max);
  EXPECT_FALSE(columns[4].min || columns[4].max);  // its table turns without end
}

}  // namespace
}  // namespace understudy::rehearsal
