#include "toolpath/inspection/program_summary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "core/text/trimmed.h"
#include "core/units.h"
#include "toolpath/inspection/comments.h"

namespace understudy::toolpath {
namespace {

constexpr double kShortest = 1e-6;    // [m], of a path that has a bead
constexpr double kSameHeight = 5e-6;  // [m]
constexpr double kUpright = 0.5 * kDegree;
constexpr double kShareOfLayer = 1e-3;  // of the printed length, below which a height is no layer

/// By length: the area below which this share of the path has it.
double percentile(const std::vector<std::pair<double, double>>& sorted, double total, double share) {
  double below = 0;
  for (const auto& [area, length] : sorted) {
    below += length;
    if (below >= share * total) return area;
  }
  return sorted.empty() ? 0 : sorted.back().first;
}

void widen(std::optional<Extent>& extent, const Vec3& from, const Vec3& to) {
  if (!extent) extent = Extent{from, from};
  for (const Vec3& p : {from, to}) {
    extent->lower = extent->lower.cwiseMin(p);
    extent->upper = extent->upper.cwiseMax(p);
  }
}

class Summary {
 public:
  Summary(const Vec3& start_W, double filament_diameter, const LayerComments& layers)
      : layers_(layers),
        tip_W_(start_W),
        filament_area_(std::numbers::pi / 4 * filament_diameter * filament_diameter) {}

  void add(const Step& step) {
    if (step.kind == StepKind::temperature && step.temperature > kCelsiusZero)
      add_temperature(step.temperature);
    if (step.kind == StepKind::temperature && !fed_any_)
      result_.heated_first = step.temperature > kCelsiusZero;
    if (step.filament > 0) fed_any_ = true;
    fed_ += step.filament;
    const double fresh = std::max(0.0, fed_ - most_fed_);
    most_fed_ = std::max(most_fed_, fed_);
    result_.filament += fresh;
    if (!moves(step)) return;
    const Vec3 end_W = step.X_WT.translation();
    if (const double length = (end_W - tip_W_).norm(); fresh > 0 && length > kShortest)
      print(step, length, fresh);
    tip_W_ = end_W;
  }

  ProgramSummary finish() {
    std::sort(areas_.begin(), areas_.end());
    result_.area_p5 = percentile(areas_, length_, 0.05);
    result_.area_p50 = percentile(areas_, length_, 0.5);
    result_.area_p95 = percentile(areas_, length_, 0.95);
    if (!result_.part) result_.part = result_.printed;
    find_layers(layers_.empty() ? heights_of_much_path() : heights_of_comments());
    return std::move(result_);
  }

 private:
  void add_temperature(double kelvin) {
    if (temperatures_.insert(kelvin).second) result_.temperatures.push_back(kelvin);
  }

  void print(const Step& step, double length, double fresh) {
    const Vec3 end_W = step.X_WT.translation();
    ++result_.prints;
    const int layer = layers_.at(step.line);
    widen(result_.printed, tip_W_, end_W);
    if (layer > 0) widen(result_.part, tip_W_, end_W);
    const double tilt = std::acos(std::clamp(tool_axis(step.X_WT).z(), -1.0, 1.0));
    result_.tilt_max = std::max(result_.tilt_max, tilt);
    if (tilt < kUpright && std::abs(end_W.z() - tip_W_.z()) < kSameHeight)
      heights_[layer][std::llround(end_W.z() / kSameHeight)] += length;
    areas_.emplace_back(fresh * filament_area_ / length, length);
    length_ += length;
  }

  std::set<std::int64_t> heights_of_much_path() const {
    std::set<std::int64_t> heights;
    for (const auto& [layer, lengths] : heights_)
      for (const auto& [key, length] : lengths)
        if (length >= kShareOfLayer * length_) heights.insert(key);
    return heights;
  }

  /// Of each layer, the one at which it prints most.
  std::set<std::int64_t> heights_of_comments() const {
    std::set<std::int64_t> heights;
    for (const auto& [layer, lengths] : heights_)
      if (layer > 0)
        heights.insert(std::ranges::max_element(lengths, {}, [](const auto& l) { return l.second; })->first);
    return heights;
  }

  void find_layers(const std::set<std::int64_t>& heights) {
    double last = 0;
    for (const std::int64_t key : heights) {
      const double height = static_cast<double>(key) * kSameHeight;
      if (result_.first_layer == 0) result_.first_layer = height;
      if (last != 0 && height - last > kSameHeight) result_.layer_heights.push_back(height - last);
      last = height;
    }
  }

  const LayerComments& layers_;
  ProgramSummary result_;
  std::set<double> temperatures_;
  bool fed_any_ = false;
  Vec3 tip_W_;
  double filament_area_;
  double fed_ = 0, most_fed_ = 0, length_ = 0;
  std::map<int, std::map<std::int64_t, double>> heights_;  // path of a layer at each, in steps of kSameHeight
  std::vector<std::pair<double, double>> areas_;           // with their lengths
};

}  // namespace

ProgramSummary summarise(const Program& program, const Vec3& start_W, double filament_diameter,
                         const LayerComments& layers) {
  Summary summary(start_W, filament_diameter, layers);
  for (const Step& step : program.steps) summary.add(step);
  return summary.finish();
}

double bead_width(double area, double height) { return area / height + height * (1 - std::numbers::pi / 4); }

std::map<std::string, std::string> slicer_facts(std::string_view text) {
  // As files write them, and as we call them.
  constexpr std::array<std::pair<std::string_view, std::string_view>, 32> kKeys{{
      {"nozzle_diameter =", "nozzle_diameter"},
      {"layer_height =", "layer_height"},
      {"first_layer_height =", "first_layer_height"},
      {"initial_layer_print_height =", "first_layer_height"},
      {"filament_diameter =", "filament_diameter"},
      {"fiber_dia_mm =", "filament_diameter"},
      {"layer_thickness_mm =", "layer_height"},
      {"first_layer_temperature =", "first_layer_temperature"},
      {"temperature =", "temperature"},
      {"nozzle_temperature_initial_layer =", "first_layer_temperature"},
      {"nozzle_temperature =", "temperature"},
      {"outputTemp =", "temperature"},
      {"filament_type =", "material"},
      {"Filament Type #1:", "material"},
      {"generated by", "generated by"},
      {"Generated with", "generated by"},
      {"Generated by", "generated by"},
      {"Sliced by", "generated by"},
      {"G-Code generated by", "generated by"},
      {"Layer height:", "layer_height"},
      {"estimated printing time (normal mode) =", "estimated time"},
      {"total estimated time:", "estimated time"},
      {"TIME:", "estimated time"},
      {"Print Time:", "estimated time"},
      {"Build time:", "estimated time"},
      {"Estimated Build Time:", "estimated time"},
      {"travel_speed =", "travel_speed"},
      {"machine_max_acceleration_extruding =", "machine_max_acceleration_extruding"},
      {"machine_max_feedrate_x =", "machine_max_feedrate_x"},
      {"machine_max_feedrate_z =", "machine_max_feedrate_z"},
      {"machine_max_jerk_x =", "machine_max_jerk_x"},
      {"machine_max_jerk_z =", "machine_max_jerk_z"},
  }};
  constexpr std::string_view kElapsed = "TIME_ELAPSED:", kTimeUntold = "6666";
  std::map<std::string, std::string> facts;
  std::string elapsed;  // [s], at the end of the last layer
  for_each_comment(text, [&](int, std::string_view line) {
    if (line.starts_with(kElapsed)) elapsed = trimmed(line.substr(kElapsed.size()));
    // BambuStudio tells two times on one line.
    if (const auto total = line.find("total estimated time:"); total != std::string_view::npos)
      line = line.substr(total);
    if (line.starts_with("BambuStudio") || line.starts_with("KISSlicer"))
      facts.try_emplace("generated by", line);
    for (const auto& [written, key] : kKeys)
      if (line.starts_with(written))
        facts.try_emplace(std::string(key), trimmed(line.substr(written.size())));
  });
  // CuraEngine by itself writes its head before it knows the time; Cura replaces it.
  if (const auto time = facts.find("estimated time"); time != facts.end() && time->second == kTimeUntold) {
    facts.erase(time);
    if (!elapsed.empty()) facts.emplace("estimated time", elapsed);
  }
  return facts;
}

}  // namespace understudy::toolpath
