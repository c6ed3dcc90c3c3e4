#include "sim/removal/material_rays.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace understudy::sim {
namespace {

constexpr double kCell = 2e-3;  // [m], side of a cell of the grid
constexpr double kMostCells = 4e6;
constexpr double kNext = 1e-9;  // [m], past a surface that a ray has met

/// Where origin + t direction is within the mill, in T; false: nowhere.
bool within(const Vec3& origin, const Vec3& direction, const EndMill& mill, double& from, double& to) {
  const double a = direction.head<2>().squaredNorm(), half = origin.head<2>().dot(direction.head<2>()),
               c = origin.head<2>().squaredNorm() - mill.radius * mill.radius;
  if (a > 1e-18) {
    const double root = half * half - a * c;
    if (root <= 0) return false;
    from = std::max(from, (-half - std::sqrt(root)) / a);
    to = std::min(to, (-half + std::sqrt(root)) / a);
  } else if (c >= 0) {
    return false;
  }
  const double down = -origin.z(), up = mill.length - origin.z(), w = direction.z();
  if (std::abs(w) > 1e-12) {
    from = std::max(from, std::min(down / w, up / w));
    to = std::min(to, std::max(down / w, up / w));
  } else if (down > 0 || up < 0) {
    return false;
  }
  return from < to;
}

/// Of the triangle itself: a smooth normal may lean over a ray that grazes.
Vec3 normal_of(const geometry::Mesh& mesh, int triangle) {
  const auto& t = mesh.triangles()[static_cast<std::size_t>(triangle)];
  const auto at = [&](std::size_t k) { return mesh.vertices()[static_cast<std::size_t>(t[k])]; };
  return (at(1) - at(0)).cross(at(2) - at(0));
}

/// From low to high, where the ray is in material. Shells may overlap, as those of beads do: what counts is
/// how many hold a place. None does at the ray's end unless that is inside.
std::vector<std::pair<double, double>> material_on(const geometry::Mesh& stock, const Vec3& p,
                                                   const Vec3& n) {
  struct Crossing {
    double at;
    int into;
  };
  std::vector<Crossing> crossings;
  int holding = stock.signed_distance(p + kAbove * n) < 0 ? 1 : 0;
  for (double at = -kBelow; at < kAbove;) {
    const auto hit = stock.ray_hit(p + at * n, n, kAbove - at);
    if (!hit) break;
    at += hit->distance;
    const int into = normal_of(stock, hit->triangle).dot(n) < 0 ? 1 : -1;
    crossings.push_back({at, into});
    holding -= into;
    at += kNext;
  }
  std::vector<std::pair<double, double>> material;
  double from = -kBelow;
  const auto add = [&](double to) {
    if (holding > 0 && to > from) material.emplace_back(from, to);
  };
  for (const Crossing& crossing : crossings) {
    add(crossing.at);
    holding += crossing.into;
    from = crossing.at;
  }
  add(kAbove);
  return material;
}

}  // namespace

MaterialRays::MaterialRays(const std::vector<SurfaceSample>& samples, const geometry::Mesh& stock)
    : samples_(samples), rays_(samples.size()), side_(kCell) {
  Vec3 lower = Vec3::Zero(), upper = Vec3::Zero();
  if (!samples.empty()) lower = upper = samples.front().position;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const SurfaceSample& s = samples[i];
    lower = lower.cwiseMin(s.position), upper = upper.cwiseMax(s.position);
    for (const auto& [from, to] : material_on(stock, s.position, s.normal))
      rays_[i].material.push_back({static_cast<float>(from), static_cast<float>(to)});
    rays_[i].before = rays_[i].material.empty() ? static_cast<float>(-kBelow) : rays_[i].material.back().to;
  }
  while ((upper - lower).array().max(side_).prod() / std::pow(side_, 3) > kMostCells) side_ *= 2;
  origin_ = lower;
  size_ = ((upper - lower) / side_).array().floor().matrix().cast<int>() + Eigen::Vector3i::Ones();
  std::vector<std::size_t> cells(samples.size());
  first_.assign(static_cast<std::size_t>(size_.prod()) + 1, 0);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    cells[i] = cell(cell_of(samples[i].position));
    ++first_[cells[i] + 1];
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  numbers_.resize(samples.size());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t i = 0; i < samples.size(); ++i) numbers_[next[cells[i]]++] = static_cast<std::uint32_t>(i);
}

std::size_t MaterialRays::cell(const Eigen::Vector3i& at) const {
  return static_cast<std::size_t>((at.z() * size_.y() + at.y()) * size_.x() + at.x());
}

Eigen::Vector3i MaterialRays::cell_of(const Vec3& p) const {
  const Vec3 scaled = ((p - origin_) / side_).array().floor();
  // Far away counts as beside the grid.
  return scaled.cwiseMax(-1.0).cwiseMin(size_.cast<double>()).cast<int>();
}

void MaterialRays::cut(const Pose& X_WT, const EndMill& mill, int line) {
  const Vec3 tip = X_WT.translation(), end = tip + mill.length * X_WT.linear().col(2);
  // A sample is at most kAbove from where the mill meets its ray.
  const Vec3 reach = Vec3::Constant(mill.radius + kAbove);
  Eigen::Vector3i low = cell_of(tip.cwiseMin(end) - reach), high = cell_of(tip.cwiseMax(end) + reach);
  low = low.cwiseMax(0), high = high.cwiseMin(size_ - Eigen::Vector3i::Ones());
  const double near = mill.radius + kAbove + side_;  // half the diagonal of a cell is below its side
  const Vec3 axis = X_WT.linear().col(2);
  for (int z = low.z(); z <= high.z(); ++z)
    for (int y = low.y(); y <= high.y(); ++y)
      for (int x = low.x(); x <= high.x(); ++x) {
        const std::size_t k = cell({x, y, z});
        if (first_[k] == first_[k + 1]) continue;
        const Vec3 way = origin_ + side_ * (Vec3(x, y, z) + Vec3::Constant(0.5)) - tip;
        const double along = std::clamp(way.dot(axis), 0.0, mill.length);
        if ((way - along * axis).squaredNorm() > near * near) continue;
        for (std::uint32_t n = first_[k]; n < first_[k + 1]; ++n) {
          const SurfaceSample& s = samples_[numbers_[n]];
          Ray& ray = rays_[numbers_[n]];
          if (ray.material.empty()) continue;
          double from = ray.material.front().from, to = ray.material.back().to;
          const Mat3 R_TW = X_WT.linear().transpose();
          if (within(R_TW * (s.position - tip), R_TW * s.normal, mill, from, to))
            take(ray, static_cast<float>(from), static_cast<float>(to), line);
        }
      }
}

void MaterialRays::take(Ray& ray, float from, float to, int line) {
  for (std::size_t i = 0; i < ray.material.size();) {
    Interval& m = ray.material[i];
    const float a = std::max(m.from, from), b = std::min(m.to, to);
    if (!(a < b)) {
      ++i;
      continue;
    }
    ray.removed += b - a;
    if (a < ray.deepest) ray.deepest = a, ray.line = line;
    const Interval above{b, m.to};
    const bool some_above = b < m.to;
    if (a > m.from) {
      m.to = a;
      if (some_above) ray.material.insert(ray.material.begin() + static_cast<std::ptrdiff_t>(i) + 1, above);
      i += some_above ? 2 : 1;
    } else if (some_above) {
      m.from = b;
      ++i;
    } else {
      ray.material.erase(ray.material.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
}

MaterialRays::Left MaterialRays::left(std::size_t sample) const {
  const Ray& ray = rays_[sample];
  return {double(ray.before), ray.material.empty() ? -kBelow : double(ray.material.back().to),
          double(ray.deepest), double(ray.removed), ray.line};
}

}  // namespace understudy::sim
