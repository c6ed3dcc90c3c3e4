#include "toolpath/lattice/segment_lattice.h"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

namespace understudy::toolpath {
namespace {

using Corner = std::array<int, 3>;
using Edge = std::pair<Corner, int>;  // its lower corner, and its axis

Corner shifted(Corner corner, int axis, int by) {
  corner[static_cast<std::size_t>(axis)] += by;
  return corner;
}

class LatticeBuilder {
 public:
  explicit LatticeBuilder(const SegmentedPart& part) : part_(part) {}

  SegmentLattice build() {
    for (const Segment& segment : part_.segments) {
      result_.segments.push_back({segment.direction, axis_of(segment.direction), {}});
      add(segment);
    }
    return std::move(result_);
  }

 private:
  void add(const Segment& segment) {
    const Vec3 up = axis_of(segment.direction);
    int axis = 0;
    up.cwiseAbs().maxCoeff(&axis);
    const int sign = up[axis] > 0 ? 1 : -1;
    // By height along the build direction: rising struts below, then the grid.
    std::map<std::pair<int, bool>, std::set<Edge>> layers;
    for (const auto& cube : segment.cubes)
      for (const Edge& edge : edges(cube)) {
        if (!taken_.insert(edge).second) continue;
        const bool rises = edge.second == axis;
        const int low = edge.first[static_cast<std::size_t>(axis)];
        const int top = sign * (rises && sign > 0 ? low + 1 : low);
        layers[{top, !rises}].insert(edge);
      }
    for (const auto& [layer, struts] : layers) {
      if (layer.second) {
        add_grid(struts);
      } else {
        add_rising(struts, axis, sign);
      }
    }
  }

  static std::vector<Edge> edges(const Corner& cube) {
    std::vector<Edge> edges;
    for (int axis = 0; axis < 3; ++axis)
      for (const int u : {0, 1})
        for (const int v : {0, 1})
          edges.emplace_back(shifted(shifted(cube, (axis + 1) % 3, u), (axis + 2) % 3, v), axis);
    return edges;
  }

  // From the nearest to the nearest, each away from what stands.
  void add_rising(std::set<Edge> struts, int axis, int sign) {
    while (!struts.empty()) {
      const auto foot = [&](const Edge& e) { return sign > 0 ? e.first : shifted(e.first, axis, 1); };
      const auto next = nearest(struts, foot);
      const Edge edge = *next;
      struts.erase(next);
      add(edge, foot(edge));
    }
  }

  // Straight on where a strut is left, else round a corner, else from the nearest node that has one.
  void add_grid(std::set<Edge> struts) {
    int along = -1;
    while (!struts.empty()) {
      auto next = struts.end();
      if (along >= 0) next = at(struts, here_, along);
      for (int axis = 0; axis < 3 && next == struts.end(); ++axis) next = at(struts, here_, axis);
      Corner from = here_;
      if (next == struts.end()) {
        next = nearest(struts, [](const Edge& e) { return e.first; });
        from = next->first;
      }
      const Edge edge = *next;
      struts.erase(next);
      along = edge.second;
      add(edge, from);
    }
  }

  // A strut along `axis` that begins or ends here.
  static std::set<Edge>::iterator at(std::set<Edge>& struts, const Corner& here, int axis) {
    const auto on = struts.find({here, axis});
    return on != struts.end() ? on : struts.find({shifted(here, axis, -1), axis});
  }

  template <typename Foot>
  std::set<Edge>::iterator nearest(std::set<Edge>& struts, const Foot& foot) const {
    const auto away = [&](const Edge& e) {
      const Corner c = foot(e);
      int sum = 0;
      for (std::size_t k = 0; k < 3; ++k) sum += (c[k] - here_[k]) * (c[k] - here_[k]);
      return sum;
    };
    return std::min_element(struts.begin(), struts.end(),
                            [&](const Edge& l, const Edge& r) { return away(l) < away(r); });
  }

  void add(const Edge& edge, const Corner& from) {
    const Corner end = shifted(edge.first, edge.second, 1), to = from == end ? edge.first : end;
    std::vector<std::array<int, 2>>& struts = result_.lattice.struts;
    const int a = node(from), b = node(to);
    result_.segments.back().struts.push_back({static_cast<int>(struts.size()), a, b});
    struts.push_back({a, b});
    here_ = to;
  }

  int node(const Corner& corner) {
    std::vector<LatticeNode>& nodes = result_.lattice.nodes;
    const auto [it, is_new] = nodes_.try_emplace(corner, static_cast<int>(nodes.size()));
    if (is_new)
      nodes.push_back({part_.origin + part_.strut * Vec3(corner[0], corner[1], corner[2]), corner[2] == 0});
    return it->second;
  }

  const SegmentedPart& part_;
  SegmentLattice result_;
  std::set<Edge> taken_;
  std::map<Corner, int> nodes_;
  Corner here_{};
};

}  // namespace

SegmentLattice segment_lattice(const SegmentedPart& part) { return LatticeBuilder(part).build(); }

void turn(SegmentLattice& segments, double angle) {
  const Eigen::AngleAxisd by(angle, Vec3::UnitZ());
  for (LatticeNode& node : segments.lattice.nodes) node.position = by * node.position;
  for (SegmentOrder& segment : segments.segments) segment.axis = by * segment.axis;
}

}  // namespace understudy::toolpath
