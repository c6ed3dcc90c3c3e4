// Writes the parts that the scenarios print on, in millimetres: make_parts FOLDER.
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <vector>

#include "core/error.h"
#include "core/file/output_file.h"
#include "core/units.h"
#include "geometry/box_mesh.h"
#include "geometry/mesh.h"
#include "models/parts/block_part.h"
#include "models/parts/swept_part.h"

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
  return {std::move(vertices), geometry::box_triangles()};
}

// For the comparison of planar layers with a conformal finish (Song 2015, figure 17): a block whose top is a
// crown, a piece of a cylinder along y. Base, crown and shell are whole numbers of 0.13 mm layers high.
constexpr double kLayer = 0.13;         // [mm]
constexpr double kCrownHalfWidth = 12;  // [mm], along x
constexpr double kCrownHalfLength = 6;  // [mm], along y
constexpr double kBaseHeight = 140 * kLayer;
constexpr double kApex = 157 * kLayer;
constexpr double kCrownRadius = 40 + 3 * kLayer;
constexpr int kCrownFacets = 80;  // sag of a chord 0.3 um

// A block on z = 0 whose top is the profile z(x), from x = -12 to 12 mm.
Mesh block_under(const std::vector<Vec2>& profile) {
  std::vector<Vec3> vertices;
  for (const double y : {-kCrownHalfLength, kCrownHalfLength})
    for (const bool top : {false, true})
      for (const Vec2& p : profile) vertices.push_back(Vec3(p.x(), y, top ? p.y() : 0) * kMillimetre);
  const int n = static_cast<int>(profile.size());
  std::vector<std::array<int, 3>> triangles;
  const auto quad = [&](int a, int b, int c, int d) {
    triangles.push_back({a, b, c});
    triangles.push_back({a, c, d});
  };
  for (int i = 0; i + 1 < n; ++i) {
    const int front = i, front_top = n + i, back = 2 * n + i, back_top = 3 * n + i;
    quad(front, front + 1, front_top + 1, front_top);        // y low
    quad(back + 1, back, back_top, back_top + 1);            // y high
    quad(front_top, front_top + 1, back_top + 1, back_top);  // top
    quad(front + 1, front, back, back + 1);                  // bottom
  }
  quad(2 * n, 0, n, 3 * n);                              // x low
  quad(n - 1, 2 * n + n - 1, 3 * n + n - 1, n + n - 1);  // x high
  return {std::move(vertices), std::move(triangles)};
}

// `shell`: how far inside the crown's surface [mm].
Mesh crown(double shell) {
  const double radius = kCrownRadius - shell;
  std::vector<Vec2> profile;
  for (int i = 0; i <= kCrownFacets; ++i) {
    const double x = kCrownHalfWidth * (2.0 * i / kCrownFacets - 1);
    profile.emplace_back(x, kApex - kCrownRadius + std::sqrt(radius * radius - x * x));
  }
  return block_under(profile);
}

Mesh crown_base() { return block_under({{-kCrownHalfWidth, kBaseHeight}, {kCrownHalfWidth, kBaseHeight}}); }

// Yu 2023, section 4: prisms whose sides an end mill goes round. Heights are ours.
constexpr double kPrismHeight = 30;  // [mm]

// Upright on z = 0; every corner must see the middle.
Mesh prism(const std::vector<Vec2>& outline) {
  std::vector<Vec3> vertices;
  for (const double z : {0.0, kPrismHeight}) {
    for (const Vec2& p : outline) vertices.push_back(Vec3(p.x(), p.y(), z) * kMillimetre);
    vertices.push_back(Vec3(0, 0, z) * kMillimetre);
  }
  const int n = static_cast<int>(outline.size()), middle = n, top = n + 1, top_middle = 2 * n + 1;
  std::vector<std::array<int, 3>> triangles;
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    triangles.push_back({i, j, top + j});
    triangles.push_back({i, top + j, top + i});
    triangles.push_back({middle, j, i});
    triangles.push_back({top_middle, top + i, top + j});
  }
  return {std::move(vertices), std::move(triangles)};
}

// Arms a third as wide as the whole (figure 6 has no figure for them), twelve corners of `radius`, in facets
// of 2 degrees: 2.3 um off at most.
std::vector<Vec2> cross_outline_mm(double width, double radius) {
  constexpr int kCornerFacets = 45;
  std::vector<Vec2> outline;
  const double end = width / 2, side = width / 6;
  for (int arm = 0; arm < 4; ++arm) {
    const double c = std::cos(arm * kPi / 2), s = std::sin(arm * kPi / 2);
    const auto add_corner = [&](const Vec2& middle, double from, double turn) {
      for (int i = 0; i <= kCornerFacets; ++i) {
        const double a = from + turn * i / kCornerFacets;
        const Vec2 p = middle + radius * Vec2(std::cos(a), std::sin(a));
        outline.emplace_back(c * p.x() - s * p.y(), s * p.x() + c * p.y());
      }
    };
    add_corner({end - radius, -side + radius}, -kPi / 2, kPi / 2);
    add_corner({end - radius, side - radius}, 0, kPi / 2);
    add_corner({side + radius, side + radius}, -kPi / 2, -kPi / 2);
  }
  return outline;
}

std::vector<Vec2> ellipse_outline_mm(double a, double b) {
  std::vector<Vec2> outline;
  for (int i = 0; i < kFacets; ++i)
    outline.emplace_back(a * std::cos(2 * kPi * i / kFacets), b * std::sin(2 * kPi * i / kFacets));
  return outline;
}

void make_prisms(const std::filesystem::path& folder) {
  const auto write = [&](const char* name, const std::vector<Vec2>& outline, const char* title) {
    write_file(folder / name, geometry::write_stl(prism(outline), title));
  };
  write("cross_90.stl", cross_outline_mm(90, 10), "cross 90 by 90 mm, corners of 10 mm, millimetres");
  write("cross_150.stl", cross_outline_mm(150, 15), "cross 150 by 150 mm, corners of 15 mm, millimetres");
  write("ellipse_50.stl", ellipse_outline_mm(50, 35), "ellipse, half axes 50 and 35 mm, millimetres");
  write("ellipse_75.stl", ellipse_outline_mm(75, 45), "ellipse, half axes 75 and 45 mm, millimetres");
}

void make_parts(const std::filesystem::path& folder) {
  check_writable(folder / "bottle.stl");
  write_file(folder / "bottle.stl",
             geometry::write_stl(bottle(), "bottle, body 31 mm, lying along y on z = 0, millimetres"));
  write_file(
      folder / "slanted_box.stl",
      geometry::write_stl(slanted_box(), "box, top slanted 15 degrees towards +x, on z = 0, millimetres"));
  write_file(folder / "crown.stl",
             geometry::write_stl(crown(0), "block with a crown of 40.39 mm, millimetres"));
  write_file(folder / "crown_core.stl",
             geometry::write_stl(crown(3 * kLayer), "the crown less a shell of 0.39 mm, millimetres"));
  write_file(folder / "crown_base.stl",
             geometry::write_stl(crown_base(), "the block under the crown, top at 18.2 mm, millimetres"));
  constexpr double kRings = 2e-3;  // [m]; outside of a bend a chord is 20 um off
  const std::vector<Vec2> round = circle_mm(6, 60);
  write_file(folder / "bent_cylinder.stl",
             geometry::write_stl(*swept_part(round, one_bend(), kRings),
                                 "12 mm round, 46 mm high, bent by 60 degrees, millimetres"));
  write_file(folder / "bent_bar.stl",
             geometry::write_stl(*swept_part(rectangle_mm(16, 10), one_bend(), kRings),
                                 "16 by 10 mm, bent by 60 degrees, millimetres"));
  write_file(folder / "s_tube.stl", geometry::write_stl(*swept_part(round, s_bend(), kRings),
                                                        "12 mm round, bent like an S, millimetres"));
  constexpr double kCloseRings = 1e-3;  // [m]; these bend more sharply
  write_file(folder / "two_bends_round.stl",
             geometry::write_stl(*swept_part(circle_mm(3, 32), bends_across_each_other(), kCloseRings),
                                 "6 mm round, two bends of 45 degrees across each other, millimetres"));
  write_file(folder / "two_bends_bar.stl",
             geometry::write_stl(*swept_part(rectangle_mm(6, 4), bends_to_one_side(), kCloseRings),
                                 "6 by 4 mm, two bends of 40 degrees to one side, millimetres"));
  write_file(folder / "two_bends_oval.stl",
             geometry::write_stl(*swept_part(oval_mm(3.5, 2.5, 32), bends_to_both_sides(), kCloseRings),
                                 "7 by 5 mm oval, bent by 55 degrees and by 80 back, millimetres"));
  write_file(folder / "column_with_arms.stl",
             geometry::write_stl(*block_part(column_with_arms(), 5),
                                 "5 x 5 x 40 mm, an arm of 10 mm on each side, millimetres"));
  make_prisms(folder);
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
  } catch (const understudy::MachineError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
}
