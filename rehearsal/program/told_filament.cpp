#include "rehearsal/program/told_filament.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/units.h"

namespace understudy::rehearsal {
namespace {

constexpr double kNearlyNothing = 0.25;  // of what the comment says
constexpr double kSameAmount = 0.2;      // of what the comment says; flow and rounding are within it
constexpr double kPurged = 0.1;          // [m], of start lines, which slicers do not count

std::string comment_of(const std::optional<double>& told) {
  return told ? fmt::format("; the slicer's comment says {:.1f} mm", to_mm(*told)) : "";
}

Finding finding_of_amount(Severity severity, int line, double fed, double told, std::string message,
                          const char* about) {
  return {"program", severity, line, 0, to_mm(fed), to_mm(told), "mm", std::move(message), 0, about};
}

}  // namespace

double fresh_filament(const toolpath::Program& program) {
  double fed = 0, most = 0;
  for (const toolpath::Step& step : program.steps) most = std::max(most, fed += step.filament);
  return most;
}

std::string relative_look(const toolpath::ExtrusionTally& tally) {
  return fmt::format("E looks relative: it does not rise at {} of {} moves from line {} on", tally.not_rising,
                     tally.moves, tally.first_line);
}

std::optional<Finding> misread_extrusion(const toolpath::ExtrusionTally& tally, double fed,
                                         const std::optional<double>& told) {
  if (!tally.looks_relative()) return std::nullopt;
  return finding_of_amount(
      Severity::error, tally.first_line, fed, told.value_or(tally.by_words),
      fmt::format("{}; read as absolute it feeds {:.1f} mm of filament, read as relative {:.1f} mm{}",
                  relative_look(tally), to_mm(fed), to_mm(tally.by_words), comment_of(told)),
      kRelativeExtrusion);
}

std::optional<Finding> other_amount(double fed, const std::optional<double>& told) {
  if (!told || *told <= 0) return std::nullopt;
  if (fed >= (1 - kSameAmount) * *told && fed <= (1 + kSameAmount) * *told + kPurged) return std::nullopt;
  return finding_of_amount(
      fed < kNearlyNothing * *told ? Severity::error : Severity::warning, 0, fed, *told,
      fmt::format("the program feeds {:.1f} mm of filament{}", to_mm(fed), comment_of(told)), kOtherAmount);
}

}  // namespace understudy::rehearsal
