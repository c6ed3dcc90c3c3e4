#include "control/gap/deposited_bead_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace understudy::control {
namespace {

constexpr double kCell = 2e-3;            // [m]
constexpr double kBeside = 0.1e-3;        // [m], that a bead may lie beside its place
constexpr double kWidestPerNozzle = 2.5;  // a blob is no wider than this many bores, half

std::int64_t cell_of(double x) { return static_cast<std::int64_t>(std::floor(x / kCell)); }

std::uint64_t key_of(std::int64_t x, std::int64_t y, std::int64_t z) {
  constexpr std::uint64_t kMask = (1u << 21) - 1;  // 21 bits of 2 mm are 4 km
  const auto part = [](std::int64_t v) { return static_cast<std::uint64_t>(v) & kMask; };
  return part(x) << 42 | part(y) << 21 | part(z);
}

/// Where a straight piece is nearest to `p`, as its share.
double nearest_share(const Vec3& from, const Vec3& to, const Vec3& p) {
  const Vec3 way = to - from;
  const double square = way.squaredNorm();
  return square > 0 ? std::clamp((p - from).dot(way) / square, 0.0, 1.0) : 0.0;
}

double distance(const Vec3& from, const Vec3& to, const Vec3& p) {
  return (from + nearest_share(from, to, p) * (to - from) - p).norm();
}

}  // namespace

DepositedBeadMap::DepositedBeadMap(const toolpath::Program& program,
                                   const machine::MachineDescription& machine)
    : layer_(machine.gap.aim) {
  const double section = std::numbers::pi / 4 * std::pow(machine.tool.filament_diameter, 2);
  Vec3 tip = Vec3::Zero();
  bool known = false;
  for (const toolpath::Step& step : program.steps) {
    if (!toolpath::moves(step)) continue;
    const Vec3 to = step.X_WT.translation();
    const double way = (to - tip).norm();
    if (known && step.kind == toolpath::StepKind::print && step.filament > 0 && way > 0) {
      const double half = 0.5 * section * step.filament / (way * layer_);
      const double bore = machine.tool.nozzle_diameter;
      beads_.push_back({tip, to, std::clamp(half, 0.5 * bore, kWidestPerNozzle * bore), step.line});
      widest_ = std::max(widest_, beads_.back().half_width);
    }
    tip = to;
    known = true;
  }
  for (std::size_t n = 0; n < beads_.size(); ++n) {
    const Bead& bead = beads_[n];
    const int pieces = 1 + static_cast<int>((bead.to_W - bead.from_W).norm() / (kCell / 2));
    for (int i = 0; i <= pieces; ++i) {
      const Vec3 p = bead.from_W + static_cast<double>(i) / pieces * (bead.to_W - bead.from_W);
      cells_.emplace_back(key_of(cell_of(p.x()), cell_of(p.y()), cell_of(p.z())),
                          static_cast<std::uint32_t>(n));
    }
  }
  std::sort(cells_.begin(), cells_.end());
  cells_.erase(std::unique(cells_.begin(), cells_.end()), cells_.end());
}

std::span<const DepositedBeadMap::Bead> DepositedBeadMap::of_line(int line) const {
  const auto before = [](const Bead& a, int l) { return a.line < l; };
  const auto begin = std::lower_bound(beads_.begin(), beads_.end(), line, before);
  return {begin, std::lower_bound(begin, beads_.end(), line + 1, before)};
}

std::span<const DepositedBeadMap::Cell> DepositedBeadMap::in_cell(std::uint64_t key) const {
  const auto begin = std::lower_bound(cells_.begin(), cells_.end(), Cell{key, 0});
  return {begin, std::lower_bound(begin, cells_.end(), Cell{key + 1, 0})};
}

bool DepositedBeadMap::shows_ground(const Place& place, double radius, int line, const Vec3& tip_W) const {
  if (beads_.empty()) return true;
  const bool first_layer = place.height < 1.5 * layer_;
  return !covers(place, 0, radius + kBeside, line, tip_W) &&
         (first_layer || covers(place, 1, 0, line, tip_W));
}

bool DepositedBeadMap::covers(const Place& place, int layers_below, double margin, int line,
                              const Vec3& tip_W) const {
  // Of the beads of this very line those before the nearest are laid, and of that one the part behind the
  // tip.
  const std::span<const Bead> here = of_line(line);
  const auto now = std::min_element(here.begin(), here.end(), [&](const Bead& a, const Bead& b) {
    return distance(a.from_W, a.to_W, tip_W) < distance(b.from_W, b.to_W, tip_W);
  });
  const Vec3 on_path = place.p_W + (place.height - layers_below * layer_) * place.up_W;
  const auto covered_by = [&](const Bead& bead) {
    if (bead.line > line || (bead.line == line && &bead > &*now)) return false;
    const bool growing = bead.line == line && &bead == &*now;
    const Vec3 to =
        growing ? Vec3(bead.from_W + nearest_share(bead.from_W, bead.to_W, tip_W) * (bead.to_W - bead.from_W))
                : bead.to_W;
    const Vec3 off = bead.from_W + nearest_share(bead.from_W, to, on_path) * (to - bead.from_W) - on_path;
    const double up = off.dot(place.up_W);
    return std::abs(up) < layer_ / 2 && (off - up * place.up_W).norm() < bead.half_width + margin;
  };
  // Pieces were filed every half a cell.
  const double reach = widest_ + margin + kCell / 4;
  const Vec3 low = on_path - Vec3::Constant(reach), high = on_path + Vec3::Constant(reach);
  for (std::int64_t x = cell_of(low.x()); x <= cell_of(high.x()); ++x)
    for (std::int64_t y = cell_of(low.y()); y <= cell_of(high.y()); ++y)
      for (std::int64_t z = cell_of(low.z()); z <= cell_of(high.z()); ++z)
        for (const Cell& cell : in_cell(key_of(x, y, z)))
          if (covered_by(beads_[cell.second])) return true;
  return false;
}

bool dot_on_ground(const machine::MachineDescription& machine, const LocalSurface& surface,
                   const DepositedBeadMap& laid, const Pose& X_WT, double height, int line) {
  Vec3 dot_T;
  if (!dot_place(machine, surface, height, dot_T)) return true;  // the picture tells
  return laid.shows_ground({X_WT * dot_T, tool_axis(X_WT), height}, machine.laser.waist_diameter / 2, line,
                           X_WT.translation());
}

}  // namespace understudy::control
