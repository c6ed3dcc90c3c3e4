#include "machine/file/urdf_bodies.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "geometry/mesh.h"
#include "machine/description.h"
#include "machine/machine_notes.h"
#include "tests/machine/arm_with_shapes.h"
#include "tests/temporary_folder.h"

namespace understudy::machine {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

template <typename Call>
std::string complaint(const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  return "none";
}

std::vector<std::string> names(const std::vector<geometry::Shape>& bodies) {
  std::vector<std::string> all;
  for (const geometry::Shape& body : bodies) all.push_back(body.name);
  return all;
}

TEST(UrdfBodies, ShapesOfTheUrdfAreBodiesOfTheAxesThatCarryThem) {
  const TemporaryFolder folder;
  const MachineDescription machine = load_machine(write_arm_with_shapes(folder.path()));
  const ChainModel& chain = machine.chain();
  EXPECT_THAT(names(chain.frame_bodies), ElementsAre("base"));
  EXPECT_THAT(names(chain.links[0].bodies), ElementsAre("upper", "upper 2"));
  ASSERT_THAT(names(chain.links[1].bodies), ElementsAre("fore", "fore 2"));
  EXPECT_EQ(std::get<geometry::Box>(chain.links[0].bodies[0].form).size, Vec3(0.06, 0.06, 0.3));
  EXPECT_LT((chain.links[0].bodies[0].X_FS.translation() - Vec3(0, 0, 0.2)).norm(), 1e-12);
  // The sphere stands 50 mm above a joint that is 400 mm above the base.
  EXPECT_LT((chain.links[1].bodies[0].X_FS.translation() - Vec3(0, 0, 0.45)).norm(), 1e-12);
  const auto& mesh = *std::get<geometry::MeshShape>(chain.links[1].bodies[1].form).mesh;
  EXPECT_NEAR(mesh.volume(), 0.04 * 0.04 * 0.25, 1e-9) << "scaled to metres";
}

TEST(UrdfBodies, PackagesAreLookedForBesideTheFileInTheKeysFolderAndAbove) {
  for (const auto& [mesh, from, to] : {std::array<std::string, 3>{"arms/meshes/fore.obj", "", ""},
                                       {"meshes/fore.obj", "", ""},
                                       {"lib/arms/meshes/fore.obj", "  urdf:", "  packages: lib\n  urdf:"}}) {
    const TemporaryFolder folder;
    const std::string file = write_arm_with_shapes(folder.path(), mesh, from, to);
    EXPECT_EQ(complaint([&] { load_machine(file); }), "none") << mesh;
  }
  const TemporaryFolder folder;  // a ROS package: urdf/ beside meshes/
  fs::create_directories(folder / "arms/meshes");
  write_file(folder / "arms/meshes/fore.obj", kForeMesh);
  const MeshPlaces places{folder / "arms/urdf/arm.urdf", folder / "elsewhere"};
  EXPECT_EQ(find_mesh("package://arms/meshes/fore.obj", places), folder / "arms/meshes/fore.obj");
  EXPECT_EQ(find_mesh("package://arms/meshes/other.obj", places), fs::path());
}

// Of packages that are elsewhere; where the file says that they are here, they must be.
TEST(UrdfBodies, AMeshThatIsNotHereLeavesItsLinkUncheckedOrIsAnError) {
  const TemporaryFolder folder;
  const auto load = [&](const std::string& to) {
    return complaint(
        [&] { load_machine(write_arm_with_shapes(folder.path(), "x.obj", "  urdf:", to + "  urdf:")); });
  };
  EXPECT_EQ(load(""), "none");
  EXPECT_THAT(load_machine_notes((folder / "machine.yaml").string()).unchecked_links, ElementsAre("fore"));
  EXPECT_THAT(load("  packages: .\n"),
              AllOf(HasSubstr("link 'fore': its collision mesh package://arms/meshes/fore.obj is not at"),
                    HasSubstr("geometry.packages"), HasSubstr("geometry.unchecked_links")));
  EXPECT_EQ(load("  unchecked_links: [fore]\n"), "none");
  EXPECT_THAT(load_machine_notes((folder / "machine.yaml").string()).unchecked_links, ElementsAre("fore"));
  EXPECT_THAT(load("  unchecked_links: [fora]\n"),
              AllOf(HasSubstr("machine.yaml:"), HasSubstr("no link 'fora', did you mean 'fore'?")));
}

TEST(UrdfBodies, AMeshOutsideTheMachinesFolderIsRefused) {
  const TemporaryFolder folder;
  write_file(folder / "fore.obj", kForeMesh);
  fs::create_directories(folder / "machine");
  const std::string file = write_arm_with_shapes(folder / "machine");
  std::string urdf = kArmWithShapes;
  urdf.replace(urdf.find("package://arms/meshes/fore.obj"), 30, "../fore.obj");
  write_file(folder / "machine/arm.urdf", urdf);
  EXPECT_THAT(complaint([&] { load_machine(file); }), HasSubstr("outside the machine file's folder"));
}

TEST(UrdfBodies, TheMachinesChecksumCoversItsMeshes) {
  const TemporaryFolder folder;
  const std::string file = write_arm_with_shapes(folder.path());
  const std::string before = load_machine(file).sha256;
  std::ofstream(folder / "arms/meshes/fore.obj", std::ios::app) << "# another\n";
  EXPECT_NE(load_machine(file).sha256, before);
}

TEST(UrdfBodies, ImpossibleShapesAreRefused) {
  const TemporaryFolder folder;
  const std::string file = write_arm_with_shapes(folder.path());
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string urdf = kArmWithShapes;
    urdf.replace(urdf.find(from), from.size(), to);
    write_file(folder / "arm.urdf", urdf);
    return complaint([&] { load_machine(file); });
  };
  EXPECT_THAT(with("size=\"0.06 0.06 0.3\"", "size=\"0.06 -1 0.3\""),
              HasSubstr("link 'upper': collision box has a size of -1 m"));
  EXPECT_THAT(with("scale=\"0.001 0.001 0.001\"", "scale=\"0.001 0 0.001\""),
              HasSubstr("link 'fore': collision mesh has the scale 0.001 0 0.001"));
  for (const std::string name : {"", "package://", "meshes/"})
    EXPECT_THAT(with("package://arms/meshes/fore.obj", name),
                HasSubstr("link 'fore': collision mesh '" + name + "' names no file"));
}

TEST(Srdf, ItsPairsAreThoseOfBodies) {
  const TemporaryFolder folder;
  const std::string file =
      write_arm_with_shapes(folder.path(), "arms/meshes/fore.obj", "  urdf:", "  srdf: arm.srdf\n  urdf:");
  write_file(folder / "arm.srdf",
             "<robot name='shapes'><disable_collisions link1='base' link2='fore' reason='Never'/></robot>");
  EXPECT_THAT(load_machine_notes(file).apart,
              ElementsAre(ElementsAre("base", "fore"), ElementsAre("base", "fore 2")));
}

TEST(Srdf, MistakesNameTheirLine) {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& text) {
    write_file(folder / "arm.srdf", text);
    return complaint([&] { read_srdf(folder / "arm.srdf", {"base", "fore"}); });
  };
  EXPECT_THAT(
      read("<robot name='a'>\n<disable_collisions link1='base' link2='four'/></robot>"),
      AllOf(HasSubstr("arm.srdf"), HasSubstr("line 2: the URDF has no link 'four', did you mean 'fore'?")));
  EXPECT_THAT(read("<robot name='a'><disable_collisions link1='base'/></robot>"), HasSubstr("has no link2"));
  EXPECT_THAT(read("<machine/>"), HasSubstr("is no SRDF"));
  EXPECT_THAT(read("<robot"), HasSubstr("is no SRDF"));
}

}  // namespace
}  // namespace understudy::machine
