#include <algorithm>
#include <map>
#include <unordered_map>

#include "report/picture/workspace_drawing.h"

namespace understudy::report {
namespace {

using Cell = std::array<int, 3>;

/// The grid, thinned, with a border of nothing: reads one point beyond every side.
class Thinned {
 public:
  Thinned(const kinematics::Workspace& w, int cells_max) : w_(w), fine_(w.grid.cells()) {
    const int longest = std::max({fine_[0], fine_[1], fine_[2]});
    stride_ = (longest + cells_max - 1) / cells_max;
    for (std::size_t i = 0; i < 3; ++i) size_[i] = (fine_[i] + stride_ - 1) / stride_;
  }
  const Cell& size() const { return size_; }
  bool inside(const Cell& c) const {
    for (std::size_t i = 0; i < 3; ++i)
      if (c[i] < 0 || c[i] >= size_[i]) return false;
    return true;
  }
  bool reaches(const Cell& c) const { return inside(c) && binding(c) == 0; }
  /// Family that ends the set at a cell that is not reached.
  int family(const Cell& c) const { return inside(c) ? w_.limits[binding(c) - 1].family : -1; }
  /// [m], of a place in units of cells from the first point.
  Vec3 place(const Vec3& at) const {
    Vec3 fine = stride_ * at;
    for (int i = 0; i < 3; ++i) fine[i] += std::min(stride_ / 2, fine_[i] - 1);
    return w_.grid.point(0, 0, 0) + w_.grid.step * fine;
  }

 private:
  int binding(const Cell& c) const {
    Cell fine;
    for (std::size_t i = 0; i < 3; ++i) fine[i] = std::min(c[i] * stride_ + stride_ / 2, fine_[i] - 1);
    return w_.binding[w_.index(fine[0], fine[1], fine[2])];
  }
  const kinematics::Workspace& w_;
  Cell fine_, size_{};
  int stride_ = 1;
};

/// A vertex for each cube of eight points, in the middle of its edges' crossings.
Vec3 net_vertex(const Thinned& grid, const Cell& corner) {
  std::array<bool, 8> in{};
  for (int k = 0; k < 8; ++k)
    in[k] = grid.reaches({corner[0] + (k & 1), corner[1] + (k >> 1 & 1), corner[2] + (k >> 2 & 1)});
  Vec3 sum = Vec3::Zero();
  int crossings = 0;
  for (int k = 0; k < 8; ++k) {
    for (int axis = 0; axis < 3; ++axis) {
      const int other = k | 1 << axis;
      if (other == k || in[k] == in[other]) continue;
      Vec3 middle(k & 1, k >> 1 & 1, k >> 2 & 1);
      middle[axis] = 0.5;
      sum += middle;
      ++crossings;
    }
  }
  return Vec3(corner[0], corner[1], corner[2]) + sum / crossings;
}

struct Quad {
  int family;
  std::array<int, 4> corner;
};

class Net {
 public:
  explicit Net(const Thinned& grid) : grid_(grid) {
    const Cell& n = grid.size();
    for (int z = -1; z < n[2]; ++z)
      for (int y = -1; y < n[1]; ++y)
        for (int x = -1; x < n[0]; ++x) add_quads({x, y, z});
  }

  /// Draws each vertex to the middle of its neighbours, at most half a cell from its place: the steps of the
  /// cells vanish, the shape of the set stays. The rim on a side of the grid moves along the rim only.
  void relax(int rounds) {
    find_rim();
    const std::vector<Motion> motion = motions();
    const std::vector<Vec3> place = vertices_;
    const Vec3 half = Vec3::Constant(0.5);
    for (int round = 0; round < rounds; ++round) {
      std::vector<Vec3> sum(vertices_.size(), Vec3::Zero());
      std::vector<int> count(vertices_.size(), 0);
      for (const Quad& quad : quads_) {
        for (std::size_t k = 0; k < 4; ++k) {
          const auto a = static_cast<std::size_t>(quad.corner[k]),
                     b = static_cast<std::size_t>(quad.corner[(k + 1) % 4]);
          for (const auto& [here, other] : {std::pair(a, b), std::pair(b, a)}) {
            if (motion[here] == Motion::rim && !touches_both_[other]) continue;
            sum[here] += vertices_[other];
            ++count[here];
          }
        }
      }
      for (std::size_t i = 0; i < vertices_.size(); ++i) {
        if (motion[i] == Motion::none || count[i] == 0) continue;
        const Vec3 middle = sum[i] / count[i];
        vertices_[i] = middle.cwiseMax(place[i] - half).cwiseMin(place[i] + half);
      }
    }
  }

  std::vector<WorkspaceSurface> meshes() const {
    std::map<int, std::vector<std::array<int, 3>>> triangles;
    for (const Quad& quad : quads_) {
      const auto& c = quad.corner;
      triangles[quad.family].push_back({c[0], c[1], c[2]});
      triangles[quad.family].push_back({c[0], c[2], c[3]});
    }
    std::vector<WorkspaceSurface> surface;
    for (auto& [family, part] : triangles) surface.push_back({family, mesh_of(part)});
    return surface;
  }

 private:
  enum class Motion { none, rim, free };

  /// Vertices where the grid's side meets a limit.
  void find_rim() {
    std::vector<bool> side(vertices_.size()), limit(vertices_.size());
    for (const Quad& quad : quads_)
      for (const int corner : quad.corner) (quad.family < 0 ? side : limit)[corner] = true;
    touches_both_.resize(vertices_.size());
    for (std::size_t i = 0; i < vertices_.size(); ++i) touches_both_[i] = side[i] && limit[i];
  }

  std::vector<Motion> motions() const {
    std::vector<Motion> motion(vertices_.size(), Motion::free);
    for (std::size_t i = 0; i < vertices_.size(); ++i)
      if (sides_[i] > 0) motion[i] = sides_[i] == 1 && touches_both_[i] ? Motion::rim : Motion::none;
    return motion;
  }

  void add_quads(const Cell& cell) {
    const bool here = grid_.reaches(cell);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Cell next = cell;
      ++next[axis];
      if (grid_.reaches(next) != here) add_quad(cell, axis, here, grid_.family(here ? next : cell));
    }
  }

  /// Across the edge from `cell` to its neighbour along `axis`, wound outwards.
  void add_quad(const Cell& cell, std::size_t axis, bool outwards, int family) {
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    Quad quad{family, {}};
    for (int k = 0; k < 4; ++k) {
      Cell at = cell;
      if (k == 0 || k == 3) --at[u];
      if (k == 0 || k == 1) --at[v];
      quad.corner[k] = vertex(at);
    }
    if (!outwards) std::swap(quad.corner[1], quad.corner[3]);
    quads_.push_back(quad);
  }

  int vertex(const Cell& corner) {
    const Cell& n = grid_.size();
    const std::int64_t key =
        (std::int64_t{corner[2] + 1} * (n[1] + 2) + corner[1] + 1) * (n[0] + 2) + corner[0] + 1;
    const auto [it, added] = index_.try_emplace(key, static_cast<int>(vertices_.size()));
    if (added) {
      vertices_.push_back(net_vertex(grid_, corner));
      int sides = 0;
      for (std::size_t i = 0; i < 3; ++i) sides += corner[i] < 0 || corner[i] >= n[i] - 1;
      sides_.push_back(sides);
    }
    return it->second;
  }

  std::shared_ptr<const geometry::Mesh> mesh_of(std::vector<std::array<int, 3>> triangles) const {
    std::unordered_map<int, int> index;
    std::vector<Vec3> used;
    for (auto& triangle : triangles) {
      for (int& corner : triangle) {
        const auto [it, added] = index.try_emplace(corner, static_cast<int>(used.size()));
        if (added) used.push_back(grid_.place(vertices_[corner]));
        corner = it->second;
      }
    }
    return std::make_shared<geometry::Mesh>(std::move(used), std::move(triangles));
  }

  const Thinned& grid_;
  std::unordered_map<std::int64_t, int> index_;
  std::vector<Vec3> vertices_;  // in units of cells
  std::vector<int> sides_;      // of the grid that a vertex lies on
  std::vector<bool> touches_both_;
  std::vector<Quad> quads_;
};

}  // namespace

std::vector<WorkspaceSurface> workspace_surface(const kinematics::Workspace& workspace, int cells_max) {
  constexpr int kRounds = 12;
  const Thinned grid(workspace, cells_max);
  Net net(grid);
  net.relax(kRounds);
  return net.meshes();
}

}  // namespace understudy::report
