#include "toolpath/gcode/rewrite/rewritten_path.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::toolpath {
namespace {

constexpr double kRounding = 1e-12;  // [m]

struct Pair {
  Pair(const std::string& asked, const std::string& written) : text(written) {
    options.X_WT_home = make_pose(Mat3(Mat3::Identity()), Vec3(0, 0, 0.05));
    original = parse_gcode(asked, "asked.gcode", options);
    rewritten = parse_gcode(written, "written.gcode", options);
  }
  RewrittenPath path() const { return {original, rewritten, text, options.X_WT_home}; }

  GcodeOptions options;
  std::string text;
  Program original, rewritten;
};

Pose tip(double x_mm, double y_mm, double z_mm) {
  return make_pose(Mat3(Mat3::Identity()), Vec3(from_mm(x_mm), from_mm(y_mm), from_mm(z_mm)));
}

TEST(RewrittenPath, APieceLiesWhereItsFilamentIsLaid) {
  // The original goes from 0 to 10 mm; the first piece feeds 0.3 of it.
  const Pair pair("G1 X0 F600\nG1 X10 E1 F600\n",
                  "G1 X0 F600\nG1 X3.2 Y0.1 E0.3\nX10.1 E1 ; 2/2 of line 2\n");
  const RewrittenPath path = pair.path();
  EXPECT_NEAR(path.asked(path.place(1, 1)).translation().x(), 3e-3, kRounding);
  EXPECT_NEAR(path.asked(path.place(2, 0.5)).translation().x(), 6.5e-3, kRounding);
  EXPECT_EQ(path.original_line(3), 2);
}

TEST(RewrittenPath, AToolIsLookedUpByItsLineAndPlace) {
  const Pair pair("G1 X0 F600\nG1 X10 E1 F600\nG1 Y10 E2\n",
                  "G1 X0.5 F600\nG1 X5.5 Y0 E0.5\nX10.5 E1 ; 2/2 of line 2\nG1 X10.5 Y10 E2\n");
  const RewrittenPath path = pair.path();
  // Half of the second piece, 0.2 mm beside it.
  EXPECT_NEAR(path.asked(3, tip(8, 0.2, 50)).translation().x(), 7.5e-3, kRounding);
  EXPECT_NEAR(path.asked(4, tip(10.5, 4, 50)).translation().y(), 4e-3, kRounding);
}

TEST(RewrittenPath, AnArcLiesUnderItsPieces) {
  const Pair pair("G1 X0 Y0 F600\nG2 X10 Y0 I5 J0 E1 F600\n",
                  "G1 X0 Y0 F600\nG1 X5 Y5 E0.5 F600\nX10 Y0 E1 ; 2/2 of line 2\n");
  const Vec3 top = pair.path().asked(2, tip(5, 5, 50)).translation();
  EXPECT_NEAR(top.x(), 5e-3, 2e-6) << "within the chords of the reader";
  EXPECT_NEAR(top.y(), 5e-3, 2e-6);
}

TEST(RewrittenPath, AnotherProgramIsRefused) {
  const Pair pair("G1 X1 F600\n; nothing\n", "G1 X1 F600\nG1 X2\n");
  EXPECT_THROW(static_cast<void>(pair.path()), InputError);
}

}  // namespace
}  // namespace understudy::toolpath
