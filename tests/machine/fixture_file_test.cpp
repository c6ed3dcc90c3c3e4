// A fixture file: a shape, and tolerances of what is clamped in place of the machine file's.
#include "machine/fixture_file.h"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "machine/description.h"
#include "tests/temporary_folder.h"

namespace understudy::machine {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class FixtureFile : public ::testing::Test {
 protected:
  FixtureFile() {
    std::filesystem::copy_file(models_folder() / "parts" / "slanted_box.stl", folder_ / "box.stl");
  }
  std::string written(const std::string& text) const {
    write_file(folder_ / "clamp.yaml", text);
    return (folder_ / "clamp.yaml").string();
  }
  std::string error_of(const std::string& text) const {
    try {
      check_fixture_file(written(text));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  const TemporaryFolder folder_;
};

TEST_F(FixtureFile, FindsItsShapeBesideItOrByName) {
  EXPECT_EQ(find_fixture(written("shape: box.stl\n")), (folder_ / "box.stl").string());
  EXPECT_EQ(find_fixture(written("shape: bottle\n")), find_fixture("bottle"));
  EXPECT_EQ(fixture_file_of("bottle"), "");
}

TEST_F(FixtureFile, StatesTolerancesInPlaceOfTheMachines) {
  const BuiltTolerances drawn = load_built_tolerances("hexapod");
  const BuiltTolerances t = load_built_tolerances(
      "hexapod", written("shape: box.stl\ntolerances: {position_mm: 0.7, ripple_um: 3}\n"));
  EXPECT_DOUBLE_EQ(t.part_position, 0.7e-3);
  EXPECT_DOUBLE_EQ(t.part_ripple, 3e-6);
  EXPECT_DOUBLE_EQ(t.part_rotation, drawn.part_rotation) << "not stated: the machine's";
  EXPECT_DOUBLE_EQ(t.part_size, drawn.part_size);
  EXPECT_DOUBLE_EQ(t.lead, drawn.lead) << "of the machine";
  EXPECT_DOUBLE_EQ(load_built_tolerances("hexapod", "bottle").part_position, drawn.part_position);
}

TEST_F(FixtureFile, AMachineWithoutTolerancesOfAPartHasThoseOfTheFixture) {
  EXPECT_DOUBLE_EQ(
      load_built_tolerances("five-axis", written("shape: box.stl\ntolerances: {size_permille: 2}\n"))
          .part_size,
      2e-3);
}

TEST_F(FixtureFile, WhatIsWrongIsToldWithLineValueAndLimit) {
  EXPECT_THAT(error_of("shape: box.stl\ntolerances: {position_mm: -0.2}\n"),
              AllOf(HasSubstr("clamp.yaml:2"), HasSubstr("tolerances.position_mm"), HasSubstr("-0.2")));
  EXPECT_THAT(error_of("shape: box.stl\ntolerances: {position_um: 200}\n"),
              AllOf(HasSubstr("position_um"), HasSubstr("position_mm")));
  EXPECT_THAT(error_of("shape: bx.stl\n"),
              AllOf(HasSubstr("clamp.yaml:1"), HasSubstr("bx.stl"), HasSubstr("bottle")));
  EXPECT_THAT(error_of("tolerances: {position_mm: 0.2}\n"), HasSubstr("shape"));
  EXPECT_THAT(error_of("shape: clamp.yaml\n"), HasSubstr("clamp.yaml"))
      << "no fixture file of a fixture file";
}

}  // namespace
}  // namespace understudy::machine
