#include "machine/machine_notes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "machine/description.h"
#include "tests/machine/arm_with_shapes.h"
#include "tests/temporary_folder.h"

namespace understudy::machine {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// The URDF gives mass to the first axis' link only.
TEST(MachineNotes, AMassThatTheUrdfLacksIsARodAndSaid) {
  const TemporaryFolder folder;
  const std::string file = write_arm_with_shapes(folder.path());
  EXPECT_THAT(load_machine_notes(file).assumed, ElementsAre("masses"));
  const ChainModel chain = load_machine(file).chain();
  EXPECT_DOUBLE_EQ(chain.links[0].mass, 2);
  // From the axis at 400 mm to the tip at 800 mm: 0.4 m of 15 kg/m, 50 mm thick.
  const Link& rod = chain.links[1];
  EXPECT_NEAR(rod.mass, 6, 1e-12);
  EXPECT_LT((rod.centre_O - Vec3(0, 0, 0.6)).norm(), 1e-12);
  EXPECT_NEAR(rod.inertia_O(0, 0), 6 * (0.4 * 0.4 / 12 + 0.05 * 0.05 / 4), 1e-12);
  EXPECT_NEAR(rod.inertia_O(2, 2), 6 * 0.05 * 0.05 / 2, 1e-12);
}

TEST(MachineNotes, AMassInTheMachineFileIsNotAssumed) {
  const TemporaryFolder folder;
  const std::string file = write_arm_with_shapes(
      folder.path(), "arms/meshes/fore.obj", "{name: b,",
      "{name: b, link: {mass_kg: 3, centre_mm: [0, 0, 500], inertia_kg_mm2: [9000, 9000, 900]},");
  EXPECT_THAT(load_machine_notes(file).assumed, IsEmpty());
  EXPECT_DOUBLE_EQ(load_machine(file).chain().links[1].mass, 3);
  EXPECT_EQ(load_machine(file).chain().links[1].bodies.size(), 2u) << "the URDF's shapes stay";
}

TEST(MachineNotes, WhatTheFileAssumesIsListedByKnownWords) {
  const TemporaryFolder folder;
  const auto with = [&](const std::string& words) {
    return load_machine_notes(write_arm_with_shapes(folder.path(), "arms/meshes/fore.obj", "mechanism: chain",
                                                    "mechanism: chain\nassumed: [" + words + "]"))
        .assumed;
  };
  EXPECT_THAT(with("play, drives"), ElementsAre("play", "drives", "masses"));
  try {
    with("plays");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("assumed is 'plays'"));
  }
  EXPECT_THAT(load_machine_notes("arm").assumed, IsEmpty());
}

TEST(MachineNotes, EveryWordStandsForSomeFigure) {
  EXPECT_EQ(assumption_of("axes.home_deg"), "home");
  EXPECT_EQ(assumption_of("axes.drive.lead_deg"), "drives");
  EXPECT_EQ(assumption_of("axes.link.mass_kg"), "masses");
  EXPECT_EQ(assumption_of("geometry.base_mm"), "place");
  EXPECT_EQ(assumption_of("geometry.base_radius_mm"), "dimensions");
  EXPECT_EQ(assumption_of("geometry.tip_mm"), "tool");
  EXPECT_EQ(assumption_of("name"), "");
  EXPECT_EQ(assumption_of("gap.aim_mm"), "");
}

}  // namespace
}  // namespace understudy::machine
