#include "geometry/stl_structure.h"

#include <cstdint>
#include <cstring>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace understudy::geometry {
namespace {

using testing::HasSubstr;

const std::string kFacet =
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";

std::string binary(std::uint32_t announced, std::size_t present) {
  std::string bytes(84 + 50 * present, '\0');
  std::memcpy(bytes.data() + 80, &announced, sizeof announced);
  return bytes;
}

std::string complaint(const std::string& bytes) {
  try {
    check_stl_structure(bytes, "part.stl");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(StlStructure, WholeFilesOfBothKindsAreAccepted) {
  EXPECT_EQ(complaint("solid part\n" + kFacet + kFacet + "endsolid part\n"), "accepted");
  EXPECT_EQ(complaint("solid a\n" + kFacet + "endsolid a\nsolid b\n" + kFacet + "endsolid b\n"), "accepted");
  EXPECT_EQ(complaint(binary(3, 3)), "accepted");
}

TEST(StlStructure, ABinaryFileWhoseTitleBeginsWithSolidIsBinary) {
  std::string bytes = binary(1, 1);
  std::memcpy(bytes.data(), "solid work of a CAD", 19);
  EXPECT_EQ(complaint(bytes), "accepted");
}

TEST(StlStructure, ATruncatedFileNamesWhatIsMissing) {
  EXPECT_THAT(complaint(binary(3, 2)), HasSubstr("184 bytes, shorter than the 234 of the 3 triangles"));
  EXPECT_THAT(complaint(binary(1, 2)), HasSubstr("184 bytes, longer than the 134 of the 1 triangles"));
  EXPECT_THAT(complaint("solid part\n" + kFacet.substr(0, kFacet.find("vertex"))),
              HasSubstr("the file ends where vertex should follow: it is truncated"));
  EXPECT_THAT(complaint("solid part\n" + kFacet), HasSubstr("where facet or endsolid should follow"));
  EXPECT_THAT(complaint(""), HasSubstr("empty file"));
  EXPECT_THAT(complaint("short"), HasSubstr("5 bytes, shorter than the 84"));
}

TEST(StlStructure, AWrongWordIsNamedWithItsLine) {
  std::string text = "solid part\n" + kFacet + "endsolid part\n";
  text.replace(text.find("vertex 1"), 6, "vortex");
  EXPECT_THAT(complaint(text), testing::AllOf(HasSubstr("part.stl:5"), HasSubstr("'vortex' where vertex")));
  text = "solid part\n" + kFacet + "endsolid part\n";
  text.replace(text.find("1 0 0"), 1, "nan");
  EXPECT_THAT(complaint(text),
              testing::AllOf(HasSubstr("part.stl:5"), HasSubstr("'nan' is not a finite number")));
  text.replace(text.find("nan"), 3, "1,5");
  EXPECT_THAT(complaint(text), HasSubstr("'1,5' where a number should follow"));
}

}  // namespace
}  // namespace understudy::geometry
