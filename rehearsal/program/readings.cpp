#include "rehearsal/program/readings.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "control/program/rotary_words.h"
#include "core/error.h"
#include "core/quantile.h"
#include "core/text/shell_quoted.h"
#include "core/units.h"
#include "toolpath/inspection/floating_share.h"

namespace understudy::rehearsal {
namespace {

using toolpath::GcodeOptions;
using toolpath::Program;
using toolpath::Step;

constexpr double kSuspicious = 10 * kDegree;  // out of the layer (median): no print is so on purpose
constexpr int kFewestMoves = 20;              // that a median is worth looking at
constexpr double kFlat = 1 * kDegree;         // out of the layer: a curved one is no better on purpose
// Floating: bridges do, and first lines on a clamped part.
constexpr double kHeld = 0.001, kLoose = 0.01;
constexpr double kUneven = 10;                        // bead_spread of no print
constexpr double kFarBetter = 4;                      // times nearer to its layer, or as even, is no chance
constexpr double kMostFilament = 10;                  // of filament over path: no bead is so thick
constexpr double kShortest = 1e-6;                    // [m]
constexpr double kLongestPivot = 0.5;                 // [m]
constexpr double kPivotSteps[] = {1e-3, 1e-4, 1e-5};  // [m], in which it is looked for
constexpr std::size_t kMovesFitted = 2000;

Program parse(const ProgramText& program, const GcodeOptions& options) {
  return toolpath::parse_gcode(program.text, program.name, options);
}

Vec3 start_of(const GcodeOptions& options) { return options.X_WT_home.translation(); }

/// A printed move of a head's slides: the tip's way is `path` + pivot * `swing`.
struct SwungMove {
  Vec3 path, swing;  // [m], and per metre of the pivot above the tip
  double filament = 0;
};

/// At most kMovesFitted, spread over the program.
std::vector<SwungMove> swung_moves(const Program& none, const Program& some, double pivot) {
  std::vector<SwungMove> moves;
  const Step *before = nullptr, *before_some = nullptr;
  for (std::size_t i = 0; i < std::min(none.steps.size(), some.steps.size()); ++i) {
    const Step &step = none.steps[i], &other = some.steps[i];
    if (!toolpath::moves(step)) continue;
    if (before != nullptr && step.kind == toolpath::StepKind::print && step.filament > 0) {
      const Vec3 path = step.X_WT.translation() - before->X_WT.translation();
      const Vec3 with = other.X_WT.translation() - before_some->X_WT.translation();
      moves.push_back({path, (with - path) / pivot, step.filament});
    }
    before = &step;
    before_some = &other;
  }
  const std::size_t stride = moves.size() / kMovesFitted + 1;
  std::vector<SwungMove> fewer;
  for (std::size_t i = 0; i < moves.size(); i += stride) fewer.push_back(moves[i]);
  return fewer;
}

double bead_spread(const std::vector<SwungMove>& moves, double pivot) {
  std::vector<double> sections;
  for (const SwungMove& move : moves)
    sections.push_back(move.filament / std::max((move.path + pivot * move.swing).norm(), kShortest));
  return quantile(sections, 0.9) / quantile(sections, 0.1);
}

/// The pivot above the tip with which the beads are most even: along the tool's axis it only offsets the
/// path, so that this stays in its layers whatever the pivot. Nothing where none is better than no pivot.
std::optional<double> fitted_pivot(const ProgramText& program, const GcodeOptions& options,
                                   RotaryReading reading, const std::string& kind) {
  const auto with = [&](double length_mm) {
    reading.coordinates = fmt::format("{}:{}", kind, length_mm);
    return parse(program, read_as(reading, options));
  };
  constexpr double kSome = 100;  // [mm]
  const auto moves = swung_moves(with(0), with(kSome), from_mm(kSome));
  if (moves.empty()) return std::nullopt;
  double best = 0, least = 0.99 * bead_spread(moves, 0);
  const auto look = [&](double from, double to, double step) {
    for (double pivot = std::max(from, step); pivot <= to; pivot += step)
      if (const double spread = bead_spread(moves, pivot); spread < least) {
        least = spread;
        best = pivot;
      }
  };
  look(0, kLongestPivot, kPivotSteps[0]);
  if (best == 0) return std::nullopt;
  for (const double step : {kPivotSteps[1], kPivotSteps[2]}) look(best - 10 * step, best + 10 * step, step);
  return best;
}

/// Logarithm of the product of all four measures: by the same factor worse in one counts
/// as much as in another, so that beads of one thickness outweigh a layer that is as flat by
/// chance. What floats counts half, and no more than ten times as much: a part's first lines may lie on what
/// is clamped.
double cost(const RotaryReading& reading) {
  const toolpath::ReadingQuality& q = reading.quality;
  return std::log(std::max(q.out_of_layer, kFlat)) + std::log(std::max(q.longest_step, kShortest)) +
         std::log(q.bead_spread) + 0.5 * std::log(std::clamp(reading.floating, kHeld, kLoose));
}

/// The first of those that agree to a per mille, which needs no options, stays first.
void sort_by_cost(std::vector<RotaryReading>& readings) {
  const auto rounded = [](const RotaryReading& r) { return std::round(1e3 * cost(r)); };
  std::stable_sort(readings.begin(), readings.end(),
                   [&](const auto& a, const auto& b) { return rounded(a) < rounded(b); });
}

/// In one measure, and not worse in the other.
bool far_better(const toolpath::ReadingQuality& best, const toolpath::ReadingQuality& used) {
  const double angle = used.out_of_layer / best.out_of_layer, spread = used.bead_spread / best.bead_spread;
  return (angle > kFarBetter && spread >= 1) || (spread > kFarBetter && angle >= 1);
}

std::string described(const RotaryReading& reading) {
  const toolpath::ReadingQuality& q = reading.quality;
  return fmt::format("{:.1f} deg (median), with beads {:.3g} times as thick in places as elsewhere",
                     to_deg(q.out_of_layer), q.bead_spread);
}

}  // namespace

GcodeOptions read_as(const RotaryReading& reading, const GcodeOptions& options) {
  GcodeOptions as = options;
  control::set_coordinates(reading.coordinates, *as.rotary);
  as.b_sign = reading.b_sign;
  as.c_sign = reading.c_sign;
  return as;
}

std::vector<RotaryReading> rank_readings(const ProgramText& program, const GcodeOptions& options) {
  std::vector<RotaryReading> readings;
  std::string refusal;
  double least_filament = std::numeric_limits<double>::infinity();
  const bool two = options.rotary->letters.size() > 1, slides = options.rotary->slides != nullptr;
  for (const std::string coordinates : {"tip", "machine", "crossing", "head", "double-head"}) {
    if ((coordinates == "machine" && !slides) || (coordinates == "double-head" && !two)) continue;
    for (const int b : {1, -1})
      for (const int c : {1, -1}) {
        if (!two && c < 0) continue;
        RotaryReading reading{coordinates, b, c, {}};
        try {
          if (coordinates.ends_with("head")) {
            const auto pivot = fitted_pivot(program, options, reading, coordinates);
            if (!pivot) continue;
            reading.coordinates += fmt::format(":{:.6g}", to_mm(*pivot));
          }
          const Program read = parse(program, read_as(reading, options));
          reading.quality = toolpath::reading_quality(read, start_of(options));
          reading.floating = toolpath::floating_share(read, start_of(options));
          // A pivot in the middle of a dome leaves nothing of its path.
          least_filament = std::min(least_filament, reading.quality.filament_share);
          if (reading.quality.filament_share <= kMostFilament) readings.push_back(reading);
        } catch (const InputError& error) {
          // The first: a program with G43.4 cannot be read as crossing in any case.
          if (refusal.empty()) refusal = error.what();
        }
      }
  }
  if (readings.empty())
    throw InputError(refusal.empty()
                         ? fmt::format("{}: no reading of its rotary words makes beads of its E: at best "
                                       "{:.3g} mm of filament on 1 mm "
                                       "of path (median), at most {:g} are a bead; is E in mm of filament?",
                                       program.name, least_filament, kMostFilament)
                         : refusal);
  sort_by_cost(readings);
  return readings;
}

std::optional<Finding> misread_words(const Program& read, const ProgramText& program,
                                     const GcodeOptions& options, const std::string& machine) {
  if (!options.rotary) return std::nullopt;
  const auto turned = std::find_if(read.steps.begin(), read.steps.end(), [](const Step& s) {
    return s.kind == toolpath::StepKind::print && s.rotary && (s.rotary->b != 0 || s.rotary->c != 0);
  });
  if (turned == read.steps.end()) return std::nullopt;
  const RotaryReading used{"", 1, 1, toolpath::reading_quality(read, start_of(options))};
  if (used.quality.moves < kFewestMoves ||
      (used.quality.out_of_layer < kSuspicious && used.quality.bead_spread < kUneven))
    return std::nullopt;
  GcodeOptions plain = options;
  plain.b_sign = plain.c_sign = 1;
  const RotaryReading best = rank_readings(program, plain).front();
  const bool better = far_better(best.quality, used.quality);
  Finding finding;
  finding.kind = "reading";
  finding.severity = better ? Severity::error : Severity::warning;
  finding.gcode_line = turned->line;
  finding.value = to_deg(used.quality.out_of_layer);
  finding.limit = to_deg(kSuspicious);
  finding.unit = "deg";
  finding.about = "rotary words";
  finding.message = fmt::format("read like this, the printed path leaves its layer by {}", described(used));
  if (better)
    finding.message += fmt::format(
        "; read as `--coordinates {}{}{}`, by {}: the program is for another kind of "
        "machine",
        best.coordinates, best.b_sign < 0 ? " --b-sign -1" : "", best.c_sign < 0 ? " --c-sign -1" : "",
        described(best));
  finding.message += fmt::format("; `understudy inspect {} --machine {}` ranks the readings",
                                 shell_quoted(program.name), shell_quoted(machine));
  return finding;
}

}  // namespace understudy::rehearsal
