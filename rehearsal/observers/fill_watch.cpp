#include "rehearsal/observers/fill_watch.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace understudy::rehearsal {
namespace {

constexpr double kShortest = 0.09e-3;    // [m]: what is shorter has no direction to speak of
constexpr double kAlongside = 0.98;      // cosine of the angle between neighbours
constexpr double kSameLevel = 0.25;      // of the height
constexpr double kLeastLength = 100e-3;  // [m]
constexpr double kShare = 0.5;

double section(double width, double height) {
  return (width - height) * height + std::numbers::pi / 4 * height * height;
}

Vec3 vector(const std::array<float, 3>& v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

}  // namespace

void FillWatch::add(const sim::LaidBead& bead, std::size_t before) {
  const bool lies = bead.adhesion == sim::Adhesion::sticks || bead.adhesion == sim::Adhesion::fused;
  if (!lies || bead.length < kShortest || bead.height <= 0) return;
  const Vec3 aside_W = bead.normal_W.cross(bead.to_W - bead.from_W).normalized();
  if (!aside_W.allFinite()) return;
  look(bead, aside_W, before);
  look(bead, -aside_W, before);
}

void FillWatch::look(const sim::LaidBead& bead, const Vec3& aside_W, std::size_t before) {
  const Vec3 middle_W = 0.5 * (bead.from_W + bead.to_W) + 0.5 * bead.height * bead.normal_W;
  const auto hit = workpiece_->beads().ray_hit(middle_W, aside_W, reach_, before);
  if (!hit) return;
  const sim::Bead other = workpiece_->beads().bead(hit->bead);
  const Vec3 from_W = vector(other.from_W), along_W = vector(other.to_W) - from_W;
  const Vec3 heading_W = (bead.to_W - bead.from_W).normalized();
  if (std::abs(along_W.dot(heading_W)) < kAlongside * along_W.norm() || along_W.norm() < kShortest) return;
  const Vec3 apart_W = from_W - middle_W;
  if (std::abs(apart_W.dot(bead.normal_W)) > kSameLevel * bead.height) return;
  const double spacing = apart_W.dot(aside_W);
  if (spacing <= 0 || spacing > reach_) return;
  const double fed = 0.5 * (fed_on(bead.line) + fed_on(other.line));
  if (fed <= 0) return;
  const double laid = 0.5 * (section(bead.width, bead.height) +
                             section(static_cast<double>(other.width), static_cast<double>(other.height)));
  // A bead that the lag leaves thin does not reach up to the nozzle; the space does.
  const bool by_gap = bead.adhesion == sim::Adhesion::sticks && bead.gap > 0;
  const double space = spacing * (by_gap ? bead.gap : bead.height);
  length_ += bead.length;
  samples_.add({static_cast<float>(fed / space), static_cast<float>(laid / space),
                static_cast<float>(bead.length), static_cast<std::uint32_t>(workpiece_->beads().size() - 1),
                bead.from_W.cast<float>()});
}

double FillWatch::fed_on(int line) const {
  const auto at = static_cast<std::size_t>(std::max(0, line));
  return at < fed_.size() ? static_cast<double>(fed_[at]) : 0;
}

const FillWatch::Sample& FillWatch::median(float Sample::*factor) const {
  const std::vector<Sample>& samples = samples_.points();
  double total = 0;
  for (const Sample& sample : samples) total += static_cast<double>(sample.length);
  std::vector<std::uint32_t> order(samples.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return samples[a].*factor < samples[b].*factor; });
  double passed = 0;
  for (const std::uint32_t i : order) {
    passed += static_cast<double>(samples[i].length);
    if (passed >= kShare * total) return samples[i];
  }
  return samples[order.back()];
}

std::optional<FillFigures> FillWatch::figures() const {
  if (length_ < kLeastLength) return std::nullopt;
  const float factor = median(&Sample::fed).fed;
  const auto first = std::find_if(samples_.points().begin(), samples_.points().end(),
                                  [&](const Sample& s) { return s.fed <= factor; });
  const sim::Bead bead = workpiece_->beads().bead(first->bead);
  return FillFigures{static_cast<double>(factor),
                     static_cast<double>(median(&Sample::laid).laid),
                     length_,
                     bead.line,
                     static_cast<double>(bead.laid_at),
                     first->place_W.cast<double>()};
}

}  // namespace understudy::rehearsal
