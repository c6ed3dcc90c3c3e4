// Links of a URDF in clearances: a mesh counts as its hull, an SRDF takes pairs out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/file/output_file.h"
#include "core/random.h"
#include "sim/collision/body_set.h"
#include "tests/machine/arm_with_shapes.h"
#include "tests/temporary_folder.h"

namespace understudy::sim {
namespace {

struct Arm {
  explicit Arm(const std::string& file)
      : machine(machine::load_machine(file)), bodies(machine, as_described(machine), nullptr, nullptr) {}
  machine::MachineDescription machine;
  BodySet bodies;

  const BodyPair* pair(const std::string& body, const std::string& obstacle) const {
    for (const BodyPair& pair : bodies.pairs())
      if (bodies.name(pair.body) == body && bodies.name(pair.obstacle) == obstacle) return &pair;
    return nullptr;
  }
};

// The block as a mesh of the URDF and as its box: every distance is the same.
TEST(LinkHulls, AMeshIsAsFarAwayAsTheBoxThatItIs) {
  const TemporaryFolder meshed, boxed;
  const std::string kBase = "base_mm: [0, 0, 0]",
                    kLower = "base_mm: [0, 0, -300]";  // the elbow 100 mm above the table
  const std::string mesh_file =
      machine::write_arm_with_shapes(meshed.path(), "arms/meshes/fore.obj", kBase, kLower);
  const std::string box_file =
      machine::write_arm_with_shapes(boxed.path(), "arms/meshes/fore.obj", kBase, kLower);
  std::string urdf = machine::kArmWithShapes;
  const std::string mesh =
      "<collision><geometry><mesh filename=\"package://arms/meshes/fore.obj\" scale=\"0.001 0.001 0.001\"/>";
  urdf.replace(urdf.find(mesh), mesh.size(),
               "<collision><origin xyz=\"0 0 0.125\"/><geometry><box size=\"0.04 0.04 0.25\"/>");
  write_file(boxed / "arm.urdf", urdf);
  Arm hull(mesh_file), box(box_file);
  Random random(11, "postures");
  int apart = 0, inside = 0;
  for (const char* obstacle : {"base", "table"})
    for (int i = 0; i < 100; ++i) {
      const BodyPair *one = hull.pair("fore 2", obstacle), *other = box.pair("fore 2", obstacle);
      if (!one) one = hull.pair(obstacle, "fore 2"), other = box.pair(obstacle, "fore 2");
      ASSERT_TRUE(one && other) << obstacle;
      Configuration at;
      at.axes[0] = random.uniform(-3, 3);
      at.axes[1] = random.uniform(-3, 3);  // beyond the range as well: into the base and the table
      const double expected = box.bodies.separation(*other, at, true).distance;
      const double found = hull.bodies.separation(*one, at, true).distance;
      if (expected > 0) {
        // Over a face the box's is exact; FCL's of a hull is off by up to 3 um a quarter of a metre away.
        EXPECT_NEAR(found, expected, 4e-6);
        ++apart;
      } else {
        EXPECT_LE(found, 0);
        ++inside;
      }
    }
  EXPECT_GT(apart, 20);
  EXPECT_GT(inside, 5);
}

TEST(LinkHulls, AMeshIsCheckedAgainstWhatIsPrinted) {
  const TemporaryFolder folder;
  const auto machine = machine::load_machine(machine::write_arm_with_shapes(folder.path()));
  BeadIndex beads;
  BodySet bodies(machine, as_described(machine), nullptr, &beads);
  // Stretched out along x at 90 degrees: from the joint 400 mm above, the block's side lies 380 mm up.
  Configuration at;
  at.axes[1] = std::numbers::pi / 2;
  Bead bead;
  bead.from_W = {0.1f, 0, 0.3785f};
  bead.to_W = {0.11f, 0, 0.3785f};
  bead.up_W = {0, 0, 1};
  bead.width = bead.height = 1e-3f;
  beads.add(bead);
  for (const BodyPair& pair : bodies.pairs()) {
    if (!pair.printed || bodies.name(pair.body) != "fore 2") continue;
    const auto near = bodies.nearest_bead(pair, at, 5e-3, 1);
    ASSERT_TRUE(near);
    EXPECT_NEAR(near->separation.distance, 1e-3, 1e-6);
    EXPECT_LE(bodies.bead_clearance(pair, at, bead), near->separation.distance + 1e-9);
    return;
  }
  FAIL() << "the mesh has no pair with what is printed";
}

TEST(LinkHulls, LinksThatMeetInAJointAndPairsOfTheSrdfAreLeftOut) {
  const TemporaryFolder folder;
  Arm without(machine::write_arm_with_shapes(folder.path()));
  EXPECT_FALSE(without.pair("base", "upper") || without.pair("upper", "base")) << "they share a joint";
  EXPECT_TRUE(without.pair("base", "fore") || without.pair("fore", "base"));
  const std::string file = machine::write_arm_with_shapes(folder.path(), "arms/meshes/fore.obj",
                                                          "  urdf:", "  srdf: arm.srdf\n  urdf:");
  write_file(folder / "arm.srdf",
             "<robot name='shapes'><disable_collisions link1='fore' link2='base' reason='Never'/></robot>");
  Arm with(file);
  EXPECT_FALSE(with.pair("base", "fore") || with.pair("fore", "base"));
  EXPECT_FALSE(with.pair("base", "fore 2") || with.pair("fore 2", "base"));
  EXPECT_TRUE(with.pair("fore", "table") || with.pair("fore 2", "table"));
}

}  // namespace
}  // namespace understudy::sim
