#include "rehearsal/inspection/extruder_letter.h"

#include "core/error.h"
#include "toolpath/inspection/program_summary.h"

namespace understudy::rehearsal {
namespace {

constexpr int kFewest = 10;                                      // moves, by which a feed shows
constexpr double kMostSpread = 3;                                // of the section, over 90 % of the path
constexpr double kLeastSection = 0.01e-6, kMostSection = 20e-6;  // [m^2]

bool prints_beads(const toolpath::ProgramSummary& summary) {
  return summary.prints >= kFewest && summary.area_p5 > 0 &&
         summary.area_p95 < kMostSpread * summary.area_p5 && summary.area_p5 > kLeastSection &&
         summary.area_p95 < kMostSection;
}

}  // namespace

std::optional<char> extruder_letter_of(const std::string& text, const std::string& file,
                                       const toolpath::GcodeOptions& options, double filament_diameter) {
  const Vec3 start_W = options.X_WT_home.translation();
  for (const char letter : {'A', 'B'}) {
    if (options.rotary && options.rotary->letters.find(letter) != std::string::npos) continue;
    toolpath::GcodeOptions as_read = options;
    as_read.extruder_letter = letter;
    // What it cannot read is counted when the program is read in earnest.
    std::vector<toolpath::UnknownWordCount> unknown;
    std::vector<toolpath::PassedOver> passed_over;
    as_read.unknown = &unknown;
    as_read.passed_over = &passed_over;
    as_read.refused = nullptr;
    try {
      const toolpath::Program program = toolpath::parse_gcode(text, file, as_read);
      if (prints_beads(toolpath::summarise(program, start_W, filament_diameter))) return letter;
    } catch (const InputError&) {  // its other letters turn axes that this machine does not have
    }
  }
  return std::nullopt;
}

}  // namespace understudy::rehearsal
