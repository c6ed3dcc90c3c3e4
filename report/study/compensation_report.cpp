#include "report/study/compensation_report.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/text/stable_number.h"
#include "core/units.h"
#include "core/version.h"
#include "report/json_text.h"

namespace understudy::report {
namespace {

using Json = nlohmann::ordered_json;
using studies::CompensatedPrint;

struct Figure {
  const char* key;
  const char* words;
  double CompensatedPrint::*value;
};
constexpr Figure kFigures[] = {
    {"drawn_um", "nominal controller, program as it is", &CompensatedPrint::drawn},
    {"calibrated_um", "calibrated controller, program as it is", &CompensatedPrint::calibrated},
    {"compensated_um", "nominal controller, compensated program", &CompensatedPrint::compensated},
    {"play_calibrated_um", "part of the play, calibrated controller", &CompensatedPrint::play_calibrated},
    {"play_compensated_um", "part of the play, compensated program", &CompensatedPrint::play_compensated},
};

double stable_um(double value) { return stable_number(to_um(value), "compensation"); }

}  // namespace

std::string compensation_table(const studies::CompensationStudy& study) {
  std::string text =
      fmt::format("{}: {} built machines, tip error while printing, um RMS\n\n{:<42} {:>8} {:>8}\n",
                  study.machine, study.prints.size(), "", "all", "worst");
  for (const Figure& figure : kFigures) {
    double worst = 0;
    for (const CompensatedPrint& print : study.prints) worst = std::max(worst, print.*figure.value);
    text +=
        fmt::format("{:<42} {:8.1f} {:8.1f}\n", figure.words, to_um(study.rms(figure.value)), to_um(worst));
  }
  return text +
         fmt::format(
             "\ncompensated / calibrated {:.2f} (worst machine {:.2f}); {:.0f} % of the play's part gone\n",
             study.ratio(), study.worst_ratio(), 100 * study.play_reduction());
}

std::string compensation_json(const studies::CompensationStudy& study) {
  Json json{{"schema", "understudy.compensation/1"},
            {"machine", study.machine},
            {"driven", study.request.driven},
            {"estimator", study.request.estimator},
            {"poses", study.request.poses},
            {"first_seed", study.request.first_seed},
            {"ratio", stable_number(study.ratio(), "compensation")},
            {"worst_ratio", stable_number(study.worst_ratio(), "compensation")},
            {"play_reduction", stable_number(study.play_reduction(), "compensation")},
            {"machines", Json::array()}};
  for (const CompensatedPrint& print : study.prints) {
    Json row{{"seed", print.seed}};
    for (const Figure& figure : kFigures) row[figure.key] = stable_um(print.*figure.value);
    row["predicted_um"] = stable_um(print.predicted);
    row["rounds"] = print.rounds;
    row["added_lines"] = print.added_lines;
    json["machines"].push_back(row);
  }
  json["command"] = study.request.command;
  json["version"] = kVersion;
  return to_text(json, 2) + "\n";
}

}  // namespace understudy::report
