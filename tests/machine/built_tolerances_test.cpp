// Tolerances of what is no geometry: read in SI, and refused where they are none.
#include "machine/built_tolerances.h"

#include "core/file/read_file.h"
#include "tests/machine/edited_file.h"

namespace understudy::machine {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class BuiltTolerancesFile : public EditedFile {
 protected:
  /// With another line in place of the part's position.
  std::string error_with(const std::string& line) {
    const std::string shipped = read_file(load_machine("hexapod").file);
    return error_of(edited(shipped, "  part:", "position_mm: 0.2 ", line));
  }
};

TEST_F(BuiltTolerancesFile, OfTheShippedHexapodAreThoseThatItsCommentsState) {
  const BuiltTolerances t = load_built_tolerances("hexapod");
  EXPECT_NEAR(300e-3 * t.lead, 0.052e-3, 1e-6) << "a screw of class 7";
  EXPECT_DOUBLE_EQ(t.part_position, 0.2e-3);
  EXPECT_DOUBLE_EQ(t.camera_centre, 2);
  // The picture's farthest corner is (428, 336) px from the principal point; the focal length is 64 x 33 px.
  EXPECT_NEAR(t.distortion * (428. * 428 + 336 * 336) / (64. * 33 * 64 * 33), 0.0033, 1e-4);
  EXPECT_DOUBLE_EQ(t.nozzle_temperature, 2);
}

TEST_F(BuiltTolerancesFile, AMachineWithoutThemIsAsDescribed) {
  const BuiltTolerances t = load_built_tolerances("five-axis");
  EXPECT_EQ(t.lead, 0);
  EXPECT_EQ(t.part_position, 0);
  EXPECT_EQ(t.filament_diameter, 0);
}

TEST_F(BuiltTolerancesFile, BelowZeroIsRefusedWithItsLimit) {
  EXPECT_THAT(error_with("position_mm: -0.2 "),
              AllOf(HasSubstr("tolerances.part.position_mm"), HasSubstr("-0.2"), HasSubstr(kInThatLine)));
}

TEST_F(BuiltTolerancesFile, AnotherUnitIsAnUnknownKey) {
  EXPECT_THAT(error_with("position_um: 200 "),
              AllOf(HasSubstr("tolerances.part.position_um"), HasSubstr("position_mm")));
}

}  // namespace
}  // namespace understudy::machine
