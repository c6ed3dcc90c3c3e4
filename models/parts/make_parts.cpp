// Writes the parts that the scenarios print on, in millimetres: make_parts FOLDER.
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <vector>

#include "core/error.h"
#include "core/output_file.h"
#include "core/units.h"
#include "geometry/mesh.h"

namespace understudy {
namespace {

using geometry::Mesh;

struct ProfilePoint {
  double y, r;  // along the axis and from it [mm]
};

constexpr int kFacets = 360;  // sag of a chord: 15.5 mm (1 - cos(pi / 360)) = 0.6 um
constexpr double kBodyRadius = 15.5;
constexpr double kPi = std::numbers::pi;

// From the bottom to the cap. The body runs from -35 to 35 mm; its extra rings beside fillet and shoulder
// keep the normals of the long facets between them exactly radial.
std::vector<ProfilePoint> bottle_profile() {
  std::vector<ProfilePoint> profile = {{-35, 0}};
  constexpr double kBottomFillet = 2;
  for (int i = 0; i <= 4; ++i) {
    const double a = kPi / 2 * i / 4;
    profile.push_back(
        {-35 + kBottomFillet * (1 - std::cos(a)), kBodyRadius - kBottomFillet * (1 - std::sin(a))});
  }
  profile.push_back({-32.5, kBodyRadius});
  profile.push_back({34.5, kBodyRadius});
  constexpr double kNeckRadius = 7, kShoulder = 14;
  for (int i = 0; i <= 12; ++i) {
    const double wave = 0.5 * (1 + std::cos(kPi * i / 12));
    profile.push_back({35 + kShoulder * i / 12, kNeckRadius + (kBodyRadius - kNeckRadius) * wave});
  }
  constexpr double kCapRadius = 9, kCapFillet = 1, kCapEnd = 65;
  profile.push_back({53, kNeckRadius});
  profile.push_back({53, kCapRadius});
  for (int i = 0; i <= 3; ++i) {
    const double a = kPi / 2 * i / 3;
    profile.push_back(
        {kCapEnd - kCapFillet * (1 - std::sin(a)), kCapRadius - kCapFillet * (1 - std::cos(a))});
  }
  profile.push_back({kCapEnd, 0});
  return profile;
}

// Lying on the table: axis along y at x = 0, z = the body's radius.
Vec3 on_ring(const ProfilePoint& p, int k) {
  const double a = 2 * kPi * k / kFacets;
  const auto clean = [](double v) { return std::abs(v) < 1e-12 ? 0.0 : v; };  // sine of pi is not quite 0
  return Vec3(clean(p.r * std::cos(a)), p.y, clean(kBodyRadius + p.r * std::sin(a))) * kMillimetre;
}

Mesh bottle() {
  const std::vector<ProfilePoint> profile = bottle_profile();
  std::vector<Vec3> vertices;
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> start;
  for (const ProfilePoint& p : profile) {
    start.push_back(static_cast<int>(vertices.size()));
    for (int k = 0; k < (p.r > 0 ? kFacets : 1); ++k) vertices.push_back(on_ring(p, k));
  }
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    const bool pole = !(profile[i].r > 0), next_pole = !(profile[i + 1].r > 0);
    for (int k = 0; k < kFacets; ++k) {
      const int j = (k + 1) % kFacets;
      const int a = start[i] + (pole ? 0 : k), b = start[i] + (pole ? 0 : j);
      const int c = start[i + 1] + (next_pole ? 0 : j), d = start[i + 1] + (next_pole ? 0 : k);
      if (!pole) triangles.push_back({a, c, b});
      if (!next_pole) triangles.push_back({a, d, c});
    }
  }
  return {std::move(vertices), std::move(triangles)};
}

// Song 2015, 6.2: a box whose top is a plane slanted by 15 degrees, here falling towards +x.
Mesh slanted_box() {
  constexpr double kHalfLength = 30, kHalfWidth = 20, kMiddleHeight = 18;  // [mm]
  const double rise = kHalfLength * std::tan(15 * kDegree);
  std::vector<Vec3> vertices;
  for (int i = 0; i < 8; ++i) {
    const double x = i & 1 ? kHalfLength : -kHalfLength;
    const double top = kMiddleHeight + (i & 1 ? -rise : rise);
    vertices.push_back(Vec3(x, i & 2 ? kHalfWidth : -kHalfWidth, i & 4 ? top : 0) * kMillimetre);
  }
  return {std::move(vertices),
          {{0, 2, 3},
           {0, 3, 1},
           {4, 5, 7},
           {4, 7, 6},
           {0, 1, 5},
           {0, 5, 4},
           {2, 6, 7},
           {2, 7, 3},
           {0, 4, 6},
           {0, 6, 2},
           {1, 3, 7},
           {1, 7, 5}}};
}

void make_parts(const std::filesystem::path& folder) {
  write_file(folder / "bottle.stl",
             geometry::write_stl(bottle(), "bottle, body 31 mm, lying along y on z = 0, millimetres"));
  write_file(
      folder / "slanted_box.stl",
      geometry::write_stl(slanted_box(), "box, top slanted 15 degrees towards +x, on z = 0, millimetres"));
}

}  // namespace
}  // namespace understudy

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: make_parts FOLDER\n", stderr);
    return 2;
  }
  try {
    understudy::make_parts(argv[1]);
  } catch (const understudy::InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
