#include "toolpath/lattice/block_segments.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "toolpath/planners/plan_checks.h"

namespace understudy::toolpath {
namespace {

using Cube = std::array<int, 3>;
using Cubes = std::set<Cube>;

constexpr double kOnSurface = 1 * kMicrometre;  // single precision of an STL of some decimetres
constexpr double kCubesMax = 30'000;            // so that the nodes stay below those of docs/limits.md
constexpr std::array kDirections = {BuildDirection::z_up, BuildDirection::y_minus, BuildDirection::y_plus,
                                    BuildDirection::x_minus, BuildDirection::x_plus};

// Which axis, and towards which side.
struct Side {
  int axis, sign;
};
Side side_of(BuildDirection direction) {
  switch (direction) {
    case BuildDirection::y_minus:
      return {1, -1};
    case BuildDirection::y_plus:
      return {1, 1};
    case BuildDirection::x_minus:
      return {0, -1};
    case BuildDirection::x_plus:
      return {0, 1};
    default:
      return {2, 1};
  }
}

Cube shifted(Cube cube, int axis, int by) {
  cube[static_cast<std::size_t>(axis)] += by;
  return cube;
}

// The cubes of a grid that are within the part.
class CubeGrid {
 public:
  CubeGrid(const geometry::Mesh& part, double strut) : part_(part), strut_(strut) {
    const Eigen::AlignedBox2d foot = this->foot();
    double cubes = 1;
    for (int k = 0; k < 3; ++k) {
      double first = part.lower()[k];
      if (k < 2) {
        const double width = foot.max()[k] - foot.min()[k];
        const double left = width - std::floor((width + kOnSurface) / strut) * strut;
        first = foot.min()[k] + 0.5 * left;
        first -= std::floor((first - part.lower()[k] + kOnSurface) / strut) * strut;
      }
      origin_[k] = first;
      const double steps = std::floor((part.upper()[k] - first + kOnSurface) / strut);
      cubes *= std::max(1.0, steps);
      count_[static_cast<std::size_t>(k)] = static_cast<int>(std::clamp(steps, 0.0, kCubesMax));
    }
    if (cubes > kCubesMax)
      throw InputError(fmt::format("room for {:.3g} cubes, more than {:g}: longer struts, or a smaller part",
                                   cubes, kCubesMax));
  }

  Cubes filled() {
    Cubes cubes;
    for (int i = 0; i < count_[0]; ++i)
      for (int j = 0; j < count_[1]; ++j)
        for (int k = 0; k < count_[2]; ++k)
          if (within({i, j, k})) cubes.insert({i, j, k});
    return cubes;
  }

  const Vec3& origin() const { return origin_; }
  Vec3 middle(const Cube& c) const { return origin_ + strut_ * Vec3(c[0] + 0.5, c[1] + 0.5, c[2] + 0.5); }

 private:
  // The face that the part stands on, about it.
  Eigen::AlignedBox2d foot() const {
    Eigen::AlignedBox2d foot;
    const double ground = part_.lower().z() + kOnSurface;
    const std::vector<Vec3>& at = part_.vertices();
    for (const auto& t : part_.triangles())
      if (std::all_of(t.begin(), t.end(),
                      [&](int v) { return at[static_cast<std::size_t>(v)].z() <= ground; }))
        for (const int v : t) foot.extend(at[static_cast<std::size_t>(v)].head<2>());
    if (foot.isEmpty())
      throw InputError(fmt::format("the part stands on no face: its lowest point is at {:.3f} mm",
                                   to_mm(part_.lower().z())));
    return foot;
  }

  // Corners, middles of edges and faces, and the middle.
  bool within(const Cube& c) {
    for (int n = 0; n < 27; ++n)
      if (!inside({2 * c[0] + n % 3, 2 * c[1] + n / 3 % 3, 2 * c[2] + n / 9})) return false;
    return true;
  }
  bool inside(const Cube& half_steps) {
    const auto [it, is_new] = inside_.try_emplace(half_steps, false);
    if (is_new) {
      const Vec3 p = origin_ + 0.5 * strut_ * Vec3(half_steps[0], half_steps[1], half_steps[2]);
      it->second = part_.signed_distance(p) <= kOnSurface;
    }
    return it->second;
  }

  const geometry::Mesh& part_;
  double strut_;
  Vec3 origin_;
  std::array<int, 3> count_{};
  std::map<Cube, bool> inside_;
};

// Those that faces connect to the first one.
Cubes piece(const Cubes& cubes) {
  Cubes piece = {*cubes.begin()};
  std::vector<Cube> open = {*cubes.begin()};
  while (!open.empty()) {
    const Cube cube = open.back();
    open.pop_back();
    for (int axis = 0; axis < 3; ++axis)
      for (const int by : {-1, 1}) {
        const Cube next = shifted(cube, axis, by);
        if (cubes.contains(next) && piece.insert(next).second) open.push_back(next);
      }
  }
  return piece;
}

std::optional<Cube> beside(const Cubes& all, const Cubes& piece) {
  const auto other = std::find_if(all.begin(), all.end(), [&](const Cube& c) { return !piece.contains(c); });
  return other == all.end() ? std::nullopt : std::optional(*other);
}

class Regions {
 public:
  Regions(const geometry::Mesh& part, double strut) : grid_(part, strut), strut_(strut) {}

  SegmentedPart segment(const geometry::Mesh& part) {
    const Cubes all = grid_.filled();
    divide(all);
    for (const BuildDirection direction : kDirections) {
      if (cubes_[direction].empty()) continue;
      require_one_piece(direction);
      if (direction != BuildDirection::z_up) require_supported(direction);
    }
    require_reached(all, part);
    SegmentedPart result{
        strut_, grid_.origin(), {}, double(all.size()) * std::pow(strut_, 3) / part.volume()};
    for (const auto& [direction, cubes] : cubes_)
      if (!cubes.empty()) result.segments.push_back({direction, {cubes.begin(), cubes.end()}});
    return result;
  }

 private:
  void divide(const Cubes& all) {
    Cubes& base = cubes_[BuildDirection::z_up];
    for (const Cube& c : all)  // the lowest of each column come first
      if (c[2] == 0 || base.contains(shifted(c, 2, -1))) base.insert(c);
    if (base.empty())
      throw InputError(
          fmt::format("no cube of {:g} mm has room on the face that the part stands on", to_mm(strut_)));
    std::array<int, 2> low{base.begin()->at(0), base.begin()->at(1)}, high = low;
    for (const Cube& c : base)
      for (const std::size_t k : {0u, 1u}) {
        low[k] = std::min(low[k], c[k]);
        high[k] = std::max(high[k], c[k]);
      }
    for (const Cube& c : all) {
      if (base.contains(c)) continue;
      if (c[0] < low[0])
        cubes_[BuildDirection::x_minus].insert(c);
      else if (c[0] > high[0])
        cubes_[BuildDirection::x_plus].insert(c);
      else if (c[1] < low[1])
        cubes_[BuildDirection::y_minus].insert(c);
      else if (c[1] > high[1])
        cubes_[BuildDirection::y_plus].insert(c);
      else
        throw InputError(
            fmt::format("the part overhangs at {}, within the limits of its base: only what "
                        "protrudes beyond them can be printed from a side",
                        place(c)));
    }
  }

  void require_one_piece(BuildDirection direction) {
    const Cubes& cubes = cubes_[direction];
    const auto other = beside(cubes, piece(cubes));
    if (!other) return;
    if (direction == BuildDirection::z_up)
      throw InputError(
          fmt::format("the part stands on the ground in 2 pieces, the other one at {}; its base must be 1",
                      place(*other)));
    throw InputError(
        fmt::format("2 segments protrude in {}, one at {} and one at {}; at most 1 can on each side",
                    name_of(direction), place(*cubes.begin()), place(*other)));
  }

  void require_supported(BuildDirection direction) {
    const auto [axis, sign] = side_of(direction);
    for (const Cube& c : cubes_[direction]) {
      const Cube below = shifted(c, axis, -sign);
      const bool stands = std::any_of(cubes_.begin(), cubes_.end(), [&](const auto& s) {
        return s.first <= direction && s.second.contains(below);
      });
      if (!stands)
        throw InputError(
            fmt::format("what protrudes in {} hangs over at {}: seen along its own build "
                        "direction nothing that is printed before is below",
                        name_of(direction), place(c)));
    }
  }

  // What is too thin for a cube would be left out unnoticed.
  void require_reached(const Cubes& all, const geometry::Mesh& part) const {
    Eigen::AlignedBox3d box;
    for (const Cube& c : all) {
      const Vec3 half = Vec3::Constant(0.5 * strut_);
      box.extend(grid_.middle(c) - half).extend(grid_.middle(c) + half);
    }
    for (int k = 0; k < 3; ++k)
      for (const int sign : {-1, 1}) {
        const double beyond = sign < 0 ? box.min()[k] - part.lower()[k] : part.upper()[k] - box.max()[k];
        if (beyond > strut_ - kOnSurface)
          throw InputError(
              fmt::format("the part reaches {:.3f} mm farther in {}{} than the cubes of {:g} mm "
                          "that have room in it",
                          to_mm(beyond), "XYZ"[k], sign < 0 ? '-' : '+', to_mm(strut_)));
      }
  }

  std::string place(const Cube& c) const { return in_mm(grid_.middle(c)); }

  CubeGrid grid_;
  double strut_;
  std::map<BuildDirection, Cubes> cubes_;
};

}  // namespace

Vec3 axis_of(BuildDirection direction) {
  const auto [axis, sign] = side_of(direction);
  return sign * Vec3::Unit(axis);
}

const char* name_of(BuildDirection direction) {
  switch (direction) {
    case BuildDirection::y_minus:
      return "Y-";
    case BuildDirection::y_plus:
      return "Y+";
    case BuildDirection::x_minus:
      return "X-";
    case BuildDirection::x_plus:
      return "X+";
    default:
      return "Z+";
  }
}

SegmentedPart segment_part(const geometry::Mesh& part, double strut) {
  check_positive("strut length", to_mm(strut), "mm");
  if (part.open_edges() > 0)
    throw InputError(
        fmt::format("the part has {} open edges, a part to fill must have 0", part.open_edges()));
  return Regions(part, strut).segment(part);
}

}  // namespace understudy::toolpath
