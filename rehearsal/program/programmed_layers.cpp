#include "rehearsal/program/programmed_layers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "rehearsal/program/programmed_areas.h"
#include "rehearsal/program/programmed_stack.h"
#include "sim/deposition/bead_section.h"

namespace understudy::rehearsal {
namespace {

constexpr double kStretch = 50e-3;     // [m], of path that shares a layer
constexpr double kLowest = 0.1;        // quantile of its gaps
constexpr double kWidest = 0.9;        // quantile of the widths that they give its beads
constexpr double kSpacing = 2e-3;      // [m], between two looks along a line
constexpr int kMostLooks = 25;         // on one line
constexpr double kLeastLayer = 20e-6;  // [m]: what is nearer is the side of a bead of the same layer
constexpr double kStrandSlope = 0.1;   // a line that leaves what is below it more steeply has no layer

std::vector<double> gaps_along(const ProgrammedLine& laid, const ProgrammedStack& stack) {
  const int looks = std::clamp(static_cast<int>(std::ceil(laid.length / kSpacing)), 1, kMostLooks);
  std::vector<double> gaps;
  for (int i = 0; i < looks; ++i)
    gaps.push_back(stack.gap(laid.from_W + (i + 0.5) / looks * (laid.to_W - laid.from_W), laid.R));
  return gaps;
}

/// It leaves what is below it, as a strut does.
bool rises(const ProgrammedLine& laid, const std::vector<double>& gaps) {
  return !(std::abs(gaps.back() - gaps.front()) <= kStrandSlope * laid.length) && laid.length > kMostLayer;
}

/// Of values with their lengths.
double quantile_by_length(std::vector<std::pair<double, double>> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  double total = 0, passed = 0;
  for (const auto& [value, length] : values) total += length;
  for (const auto& [value, length] : values)
    if ((passed += length) >= share * total) return value;
  return values.back().first;
}

}  // namespace

/// A line and what lies below it.
struct ProgrammedLayers::Sample {
  double length = 0, gap = 0, area = 0;  // [m], [m], [m^2]
  int line = 0;
};

struct ProgrammedLayers::Stretch {
  Layer layer;
  double length = 0;  // [m], with something below
  int first_line = 0, last_line = 0;
  std::map<int, Layer> thicker;  // by line
};

ProgrammedLayers::ProgrammedLayers(const toolpath::Program& program,
                                   const machine::MachineDescription& machine,
                                   const std::shared_ptr<const geometry::Mesh>& part, double told,
                                   const toolpath::ToldBeads& beads)
    : limits_(machine.gap), told_(told) {
  const std::vector<float> areas = programmed_areas(program, machine);
  std::vector<std::pair<double, double>> printed;
  for (const float area : areas)
    if (area > 0) printed.emplace_back(area, 1);
  told_area_ = quantile_by_length(std::move(printed), 0.5);
  std::vector<Sample> samples;
  std::vector<Stretch> stretches;
  double length_so_far = 0;
  lay_program(program, machine, part, areas, [&](const ProgrammedLine& laid, const ProgrammedStack& stack) {
    const std::vector<double> gaps = gaps_along(laid, stack);
    double least = std::numeric_limits<double>::infinity();
    for (const double gap : gaps) {
      if (gap > kLeastLayer) least = std::min(least, gap);
      if (gap > kLeastLayer && gap < kMostLayer && !rises(laid, gaps))
        samples.push_back({laid.length / static_cast<double>(gaps.size()), gap, laid.area, laid.line});
    }
    length_so_far += laid.length;
    if (length_so_far >= kStretch) {
      stretches.push_back(close(samples));
      length_so_far = 0;
    }
    return least;
  });
  stretches.push_back(close(samples));
  for (const Stretch& stretch : stretches) assign(stretch);
  take_told(beads, areas);
  carry_on(program);
  typical_ = typical(stretches);
}

void ProgrammedLayers::take_told(const toolpath::ToldBeads& beads, const std::vector<float>& areas) {
  if (beads.empty()) return;
  if (layers_.size() < areas.size()) layers_.resize(areas.size());
  for (std::size_t line = 0; line < areas.size(); ++line) {
    const toolpath::ToldBead told = beads.at(static_cast<int>(line));
    const double area = static_cast<double>(areas[line]), told_area = told.area();
    if (area <= 0 || told_area <= 0 || std::abs(area - told_area) > kSameBead * told_area) continue;
    const auto height = static_cast<float>(told.height);
    if (beads.supports() && layers_[line].layer > height) continue;
    layers_[line] = {height, areas[line]};
  }
}

/// What still flows as a travel begins belongs to the line before it.
void ProgrammedLayers::carry_on(const toolpath::Program& program) {
  Layer before;
  for (const toolpath::Step& step : program.steps) {
    const auto line = static_cast<std::size_t>(std::max(0, step.line));
    if (step.filament > 0) {
      before = line < layers_.size() ? layers_[line] : Layer{};
    } else if (before.layer > 0) {
      if (layers_.size() <= line) layers_.resize(line + 1);
      layers_[line] = before;
    }
  }
}

void ProgrammedLayers::assign(const Stretch& stretch) {
  const auto last = static_cast<std::size_t>(std::max(0, stretch.last_line));
  if (layers_.size() <= last) layers_.resize(last + 1);
  for (auto line = static_cast<std::size_t>(std::max(0, stretch.first_line)); line <= last; ++line)
    layers_[line] = stretch.layer;
  for (const auto& [line, layer] : stretch.thicker) layers_[static_cast<std::size_t>(line)] = layer;
}

/// Ends a stretch of path: the layer of its samples, which are taken out.
ProgrammedLayers::Stretch ProgrammedLayers::close(std::vector<Sample>& samples) {
  Stretch stretch;
  if (samples.empty()) return stretch;
  std::vector<std::pair<double, double>> gaps, areas, widths;
  std::map<int, Layer> lines;  // the lowest gap of each
  for (const Sample& sample : samples) {
    gaps.emplace_back(sample.gap, sample.length);
    areas.emplace_back(sample.area, sample.length);
    widths.emplace_back(sim::bead_width(sample.area, sample.gap), sample.length);
    stretch.length += sample.length;
    const Layer own{static_cast<float>(sample.gap), static_cast<float>(sample.area)};
    const auto [line, is_new] = lines.emplace(sample.line, own);
    if (!is_new) line->second.layer = std::min(line->second.layer, own.layer);
  }
  stretch.layer = {static_cast<float>(quantile_by_length(std::move(gaps), kLowest)),
                   static_cast<float>(quantile_by_length(std::move(areas), 0.5))};
  const double width = quantile_by_length(std::move(widths), kWidest);
  for (auto [line, own] : lines) {
    own.layer =
        std::min(own.layer, static_cast<float>(sim::bead_height(static_cast<double>(own.area), width)));
    if (line >= 0 && own.layer > stretch.layer.layer) stretch.thicker.emplace(line, own);
  }
  stretch.first_line = samples.front().line;
  stretch.last_line = samples.back().line;
  samples.clear();
  return stretch;
}

ProgrammedLayers::Layer ProgrammedLayers::typical(const std::vector<Stretch>& stretches) {
  std::vector<std::pair<double, double>> layers, areas;
  for (const Stretch& stretch : stretches) {
    layers.emplace_back(static_cast<double>(stretch.layer.layer), stretch.length);
    areas.emplace_back(static_cast<double>(stretch.layer.area), stretch.length);
  }
  return {static_cast<float>(quantile_by_length(std::move(layers), 0.5)),
          static_cast<float>(quantile_by_length(std::move(areas), 0.5))};
}

sim::GapBand ProgrammedLayers::told_band() const {
  return told_ > 0 ? sim::gap_band(limits_, told_, told_area_) : sim::gap_band(limits_);
}

sim::GapBand ProgrammedLayers::band(int line) const {
  const auto at = static_cast<std::size_t>(std::max(0, line));
  const Layer layer = at < layers_.size() ? layers_[at] : Layer{};
  if (layer.layer <= 0) return told_band();
  return sim::gap_band(limits_, static_cast<double>(layer.layer), static_cast<double>(layer.area));
}

double ProgrammedLayers::layer(int line) const {
  const auto at = static_cast<std::size_t>(std::max(0, line));
  return at < layers_.size() ? static_cast<double>(layers_[at].layer) : 0;
}

sim::GapBand ProgrammedLayers::typical_band() const {
  if (typical_.layer <= 0) return told_band();
  return sim::gap_band(limits_, static_cast<double>(typical_.layer), static_cast<double>(typical_.area));
}

}  // namespace understudy::rehearsal
