#include "toolpath/gcode/gcode_line_reader.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/text/take_line.h"

namespace understudy::toolpath {
namespace {

TEST(GcodeLineReader, ReadsLineByLineWhatTheWholeTextGives) {
  const std::string text = "G91\nG1 X1 E0.1 F600\nG2 X2 I1 E0.2\nG28\nM106 S100\n";
  const GcodeOptions options;
  const Program whole = parse_gcode(text, "p.gcode", options);
  const std::string file = "p.gcode";
  std::vector<Step> steps;
  GcodeLineReader reader(file, options, steps);
  int number = 0;
  for (std::string_view rest = text; !rest.empty();) reader.read(take_line(rest), ++number);
  ASSERT_EQ(steps.size(), whole.steps.size());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    EXPECT_TRUE(steps[i].X_WT.isApprox(whole.steps[i].X_WT, 0));
    EXPECT_EQ(steps[i].filament, whole.steps[i].filament);
    EXPECT_EQ(steps[i].line, whole.steps[i].line);
  }
}

TEST(GcodeLineReader, ALineThatFailsLeavesNothingBehindWhereThatIsAskedFor) {
  const std::string file = "p.gcode";
  const GcodeOptions options;
  std::vector<Step> steps;
  GcodeLineReader reader(file, options, steps);
  reader.read("G1 X1 F600", 1);
  EXPECT_THROW(reader.read_or_undo("G91 G1 X5 R1", 2), InputError) << "R belongs to no command here";
  EXPECT_THROW(reader.read_or_undo("M428", 3), InputError) << "an unknown word, told at once";
  reader.read_or_undo("G1 X2", 4);
  ASSERT_EQ(steps.size(), 2);
  EXPECT_DOUBLE_EQ(steps[1].X_WT.translation().x(), 2e-3) << "G91 of the line that failed is not in force";
}

}  // namespace
}  // namespace understudy::toolpath
