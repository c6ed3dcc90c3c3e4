#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "core/error.h"
#include "core/random.h"
#include "geometry/mesh.h"
#include "tests/geometry/test_solids.h"
#include "tests/temporary_folder.h"

namespace understudy::geometry {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class StlFile : public ::testing::Test {
 protected:
  void save(const std::string& bytes) { std::ofstream(path_, std::ios::binary) << bytes; }
  std::string rejection(const std::string& bytes, const MeshCheck& check = {}) {
    save(bytes);
    try {
      read_stl(path_, check);
    } catch (const InputError& error) {
      const std::string line = error.what();
      EXPECT_EQ(line.find('\n'), std::string::npos) << line;
      EXPECT_THAT(line, StartsWith(path_.string() + ":"));
      return line.substr(path_.string().size());
    }
    return "accepted";
  }
  static std::string binary(const Triangles& t) {
    return write_stl(Mesh(t.vertices, t.triangles), "a solid");
  }
  static std::string text(const Triangles& t) {
    std::ostringstream out;
    out << "solid part of many words\n";
    for (const auto& triangle : t.triangles) {
      out << "  facet normal 0 0 0\n    outer loop\n";
      for (const int v : triangle)
        out << "      vertex " << 1e3 * t.vertices[static_cast<std::size_t>(v)].transpose() << "\n";
      out << "    endloop\n  endfacet\n";
    }
    out << "endsolid part of many words\n";
    return out.str();
  }

  const TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_ / "part.stl";
  const Triangles box_ = box(Vec3(0, 0, 0), Vec3(0.02, 0.03, 0.04));
};

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  text.replace(text.find(what), what.size(), with);
  return text;
}

void set_float(std::string& bytes, std::size_t triangle, std::size_t number, float value) {
  std::memcpy(bytes.data() + 84 + 50 * triangle + 12 + 4 * number, &value, 4);
}

TEST_F(StlFile, BinaryAndTextGiveTheSameWeldedSolidInMetres) {
  for (const std::string& bytes : {binary(box_), text(box_), replaced(binary(box_), "a solid", "solid a")}) {
    save(bytes);
    const auto mesh = read_stl(path_);
    EXPECT_EQ(mesh->triangles().size(), 12u);
    EXPECT_EQ(mesh->open_edges(), 0);
    EXPECT_EQ(mesh->vertices().size(), 24u);           // 8 welded, then split at the creases
    EXPECT_NEAR(mesh->volume(), 24e-6, 24e-6 * 1e-6);  // single precision
  }
}

TEST_F(StlFile, WritingAndReadingKeepsEveryCornerToSinglePrecision) {
  const Triangles ball = sphere(0.0155, 20, 30);
  save(binary(ball));
  const auto mesh = read_stl(path_);
  ASSERT_EQ(mesh->triangles().size(), ball.triangles.size());
  for (std::size_t t = 0; t < ball.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_LT((mesh->vertices()[static_cast<std::size_t>(mesh->triangles()[t][k])] -
                 ball.vertices[static_cast<std::size_t>(ball.triangles[t][k])])
                    .norm(),
                0.0155 * std::ldexp(1, -22));  // rounding of three coordinates and of welding
  EXPECT_EQ(write_stl(*mesh, "x"), write_stl(*mesh, "x"));
}

TEST_F(StlFile, MissingFileAndEmptyFileAreNamed) {
  EXPECT_THROW(
      {
        try {
          read_stl(path_);
        } catch (const InputError& error) {
          EXPECT_THAT(error.what(), AllOf(HasSubstr(path_.string()), HasSubstr("No such file")));
          throw;
        }
      },
      InputError);
  EXPECT_THAT(rejection(""), HasSubstr("empty"));
  EXPECT_THAT(rejection("solid nothing\nendsolid nothing\n"), Not(HasSubstr("accepted")));
  EXPECT_THAT(rejection(std::string(84, '\0')), Not(HasSubstr("accepted")));
}

TEST_F(StlFile, TruncatedBinaryNamesBothSizes) {
  const std::string whole = binary(box_);
  EXPECT_THAT(
      rejection(whole.substr(0, whole.size() - 7)),
      AllOf(HasSubstr("677 bytes, shorter than the 684 of the 12 triangles"), HasSubstr("truncated")));
  EXPECT_THAT(rejection(whole.substr(0, 50)), HasSubstr("50 bytes, shorter than the 84"));
  EXPECT_THAT(rejection(whole + "more"), HasSubstr("688 bytes, longer than the 684"));
}

TEST_F(StlFile, TruncatedOrMalformedTextNamesTheLine) {
  const std::string whole = text(box_);
  EXPECT_THAT(rejection(whole.substr(0, whole.find("endsolid"))),
              AllOf(StartsWith(":86"), HasSubstr("endsolid"), HasSubstr("truncated")));
  EXPECT_THAT(rejection(whole.substr(0, whole.find("vertex") + 9)),
              AllOf(StartsWith(":4"), HasSubstr("truncated")));
  EXPECT_THAT(rejection(replaced(whole, "endloop", "vertex 1 2 3 endloop")),
              AllOf(StartsWith(":7:"), HasSubstr("'vertex' where endloop should follow")));
  EXPECT_THAT(rejection(replaced(whole, "vertex 0", "vertex 1,5")),
              AllOf(StartsWith(":4:"), HasSubstr("'1,5' where a number should follow")));
  EXPECT_THAT(rejection(whole + "facet"), HasSubstr("'facet' where solid or the end"));
}

TEST_F(StlFile, NonFiniteCoordinatesAreNamed) {
  EXPECT_THAT(rejection(replaced(text(box_), "vertex 0", "vertex nan")),
              AllOf(StartsWith(":4:"), HasSubstr("'nan'")));
  EXPECT_THAT(rejection(replaced(text(box_), "vertex 0", "vertex 1e999")), HasSubstr("'1e999'"));
  for (std::size_t number = 0; number < 9; ++number) {
    std::string bytes = binary(box_);
    set_float(bytes, 4, number, std::numeric_limits<float>::infinity());
    EXPECT_THAT(rejection(bytes), AllOf(HasSubstr("triangle 5"), HasSubstr("inf"), HasSubstr("not finite")));
    set_float(bytes, 4, number, std::numeric_limits<float>::quiet_NaN());
    EXPECT_THAT(rejection(bytes), AllOf(HasSubstr("triangle 5"), HasSubstr("nan")));
  }
}

TEST_F(StlFile, AnOpenSurfaceIsRefusedUnlessAllowed) {
  Triangles open = box_;
  open.triangles.pop_back();
  EXPECT_THAT(rejection(binary(open)),
              AllOf(HasSubstr("3 edges do not belong to exactly 2"), HasSubstr("mm")));
  save(binary(open));
  EXPECT_EQ(read_stl(path_, {.allow_open = true})->open_edges(), 3);
}

TEST_F(StlFile, MixedWindingAndInsideOutAreRefused) {
  Triangles mixed = box_;
  std::swap(mixed.triangles[3][0], mixed.triangles[3][1]);
  EXPECT_THAT(rejection(binary(mixed)),
              HasSubstr("3 edges, and 0 are allowed, join triangles of opposite winding"));
  Triangles inverted = box_;
  for (auto& t : inverted.triangles) std::swap(t[0], t[1]);
  EXPECT_THAT(rejection(binary(inverted)), HasSubstr("the volume is -24000 mm^3, below 0"));
}

TEST_F(StlFile, TrianglesWithoutAreaAreRefused) {
  for (const bool collapsed : {true, false}) {
    std::string bytes = binary(box_);
    for (std::size_t number = 0; number < 3; ++number) {
      set_float(bytes, 4, number, static_cast<float>(number));
      set_float(bytes, 4, 3 + number, static_cast<float>(collapsed ? number : 2 * number));
      set_float(bytes, 4, 6 + number, static_cast<float>(4 * number));
    }
    EXPECT_THAT(rejection(bytes), AllOf(HasSubstr("triangle 5 at (0.000, 1.000, 2.000) mm has no area"),
                                        HasSubstr("corners' rounding")));
  }
}

TEST_F(StlFile, AWrongUnitShowsInTheSize) {
  const auto scaled = [](double scale) { return binary(box(Vec3::Zero(), scale * Vec3(0.02, 0.03, 0.04))); };
  EXPECT_EQ(rejection(scaled(1e-3)),
            ": 0.0539 mm across, smaller than 1 mm: is it in metres? STL files are read as millimetres");
  EXPECT_THAT(rejection(scaled(1e3)), HasSubstr("53851.6 mm across, larger than 2000 mm"));
  EXPECT_EQ(rejection(scaled(1e3), {.largest_size = 100}), "accepted");
}

TEST_F(StlFile, RandomDamageGivesAMeshOrOneClearError) {
  const std::string originals[] = {binary(box_), text(box_)};
  Random random(21, "stl damage");
  for (int i = 0; i < 600; ++i) {
    std::string bytes = originals[i % 2];
    const auto position = [&] {
      return static_cast<std::size_t>(random.uniform() * static_cast<double>(bytes.size()));
    };
    for (int n = 1 + static_cast<int>(random.uniform() * 4); n > 0; --n) {
      if (random.uniform() < 0.2)
        bytes.resize(position());
      else if (!bytes.empty())
        bytes[position()] = static_cast<char>(random.bits());
      if (bytes.empty()) break;
    }
    rejection(bytes, {.allow_open = i % 3 == 0});  // checks that an error is one line and names the file
  }
}

}  // namespace
}  // namespace understudy::geometry
