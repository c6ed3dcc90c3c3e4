#include "sim/removal/removal.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <variant>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"

namespace understudy::sim {
namespace {

constexpr double kStep = 0.05e-3;   // [m], of the face between two cuts
constexpr double kCounts = 1e-6;    // [m]: less is rounding, not a cut
constexpr double kRounding = 1e-6;  // [m]

/// A cylinder on the tool's axis from the tip on.
const geometry::Cylinder* cutter(const geometry::Shape& body, const machine::Tool& tool) {
  const auto* cylinder = std::get_if<geometry::Cylinder>(&body.form);
  if (cylinder == nullptr || cylinder->radius > tool.flat_diameter / 2 + kRounding) return nullptr;
  const Vec3 bottom = body.X_FS * Vec3(0, 0, -cylinder->length / 2);
  return bottom.norm() < kRounding ? cylinder : nullptr;
}

struct Weighted {
  double value, weight;
};

/// Of values with weights: the least that the share of the weight does not exceed.
double quantile(std::vector<Weighted> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end(), [](const auto& a, const auto& b) { return a.value < b.value; });
  double all = 0, sum = 0;
  for (const Weighted& v : values) all += v.weight;
  for (const Weighted& v : values)
    if ((sum += v.weight) >= share * all) return v.value;
  return values.back().value;
}

double mean(const std::vector<Weighted>& values) {
  double all = 0, sum = 0;
  for (const Weighted& v : values) all += v.weight, sum += v.weight * v.value;
  return all > 0 ? sum / all : 0;
}

}  // namespace

std::string cutter_of(const machine::Tool& tool) {
  for (const geometry::Shape& body : tool.bodies)
    if (cutter(body, tool)) return body.name;
  return "";
}

EndMill end_mill_of(const machine::Tool& tool) {
  if (tool.prints()) throw InputError("the tool prints: it is no end mill");
  constexpr double kLength = 20e-3;  // [m], of a tool without bodies
  for (const geometry::Shape& body : tool.bodies)
    if (const auto* found = cutter(body, tool)) return {tool.flat_diameter / 2, found->length};
  return {tool.flat_diameter / 2, kLength};
}

RemovalObserver::RemovalObserver(const Workblank& blank)
    : mill_(blank.mill),
      spacing_(blank.spacing),
      samples_(sample_surface(*blank.part, spacing_)),
      truth_{MaterialRays(samples_, *blank.stock), {}},
      planned_(truth_) {}

void RemovalObserver::observe(const Snapshot& snapshot) {
  sweep(snapshot.X_WT, snapshot.line, truth_);
  sweep(snapshot.X_WT_commanded, snapshot.line, planned_);
}

void RemovalObserver::sweep(const Pose& X_WT, int line, Sweep& of) const {
  const Pose from = of.last.value_or(X_WT);
  const double way = (X_WT.translation() - from.translation()).norm() +
                     angle_between(from.linear(), X_WT.linear()) * (mill_.radius + kAbove);
  const int parts = static_cast<int>(std::ceil(way / kStep));
  if (!of.last) of.rays.cut(X_WT, mill_, line);
  for (int k = 1; k <= parts; ++k)
    of.rays.cut(interpolate(from, X_WT, static_cast<double>(k) / parts), mill_, line);
  of.last = X_WT;
}

RemovalSummary RemovalObserver::summary() const {
  RemovalSummary summary;
  summary.spacing = spacing_;
  double area = 0, finished = 0;
  std::vector<Weighted> truth, planned;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const auto real = truth_.rays.left(i), ideal = planned_.rays.left(i);
    const double weight = samples_[i].area;
    area += weight;
    summary.volume += weight * real.removed;
    summary.planned_gouge = std::max(summary.planned_gouge, -ideal.deepest);
    if (-real.deepest > summary.gouge) {
      summary.gouge = -real.deepest;
      summary.gouge_place_W = samples_[i].position;
      summary.gouge_line = real.line;
    }
    if (ideal.removed < kCounts) continue;
    finished += weight;
    truth.push_back({std::max(0.0, real.top), weight});
    planned.push_back({std::max(0.0, ideal.top), weight});
  }
  if (area > 0) summary.finished_fraction = finished / area;
  constexpr double kShare = 0.95;
  summary.left_over_mean = mean(truth);
  summary.left_over_p95 = quantile(truth, kShare);
  summary.left_over_max = quantile(truth, 1);
  summary.planned_left_over_p95 = quantile(planned, kShare);
  summary.planned_left_over_max = quantile(planned, 1);
  return summary;
}

MilledSurface RemovalObserver::surface() const {
  MilledSurface surface{samples_, {}, {}};
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const auto left = truth_.rays.left(i);
    surface.before.push_back(left.before);
    surface.after.push_back(left.top);
  }
  return surface;
}

std::string surface_ply(const std::vector<SurfaceSample>& samples, const std::vector<double>& heights,
                        const std::string& title) {
  static_assert(std::endian::native == std::endian::little, "the format is little endian");
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment {}, millimetres; height over the finished surface\n"
      "element vertex {}\nproperty float x\nproperty float y\nproperty float z\nproperty float height_mm\n"
      "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
      title, 4 * samples.size(), samples.size());
  const auto put = [&bytes](auto value) {
    char raw[sizeof(value)];
    std::memcpy(raw, &value, sizeof(value));
    bytes.append(raw, sizeof(value));
  };
  for (std::size_t i = 0; i < samples.size(); ++i)
    for (const Vec3& corner : samples[i].corners) {
      const Vec3 p = corner + heights[i] * samples[i].normal;
      for (const double x : p) put(static_cast<float>(to_mm(x)));
      put(static_cast<float>(to_mm(heights[i])));
    }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    put(static_cast<unsigned char>(4));
    for (std::size_t k = 0; k < 4; ++k) put(static_cast<std::int32_t>(4 * i + k));
  }
  return bytes;
}

}  // namespace understudy::sim
