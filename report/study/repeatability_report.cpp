#include "report/study/repeatability_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/text/stable_number.h"
#include "core/units.h"
#include "core/version.h"
#include "report/json_text.h"

namespace understudy::report {
namespace {

using Json = nlohmann::ordered_json;

double stable(double value) { return stable_number(value, "repeatability"); }

}  // namespace

std::string repeatability_json(const studies::Repeatability& study) {
  const auto& o = study.options;
  Json json{
      {"schema", "understudy.repeatability/1"},
      {"machine", study.machine},
      {"centre_mm", {stable(to_mm(o.centre.x())), stable(to_mm(o.centre.y())), stable(to_mm(o.centre.z()))}},
      {"edge_mm", stable(to_mm(o.edge))},
      {"lean_deg", stable(to_deg(o.lean))},
      {"cycles", o.cycles},
      {"tests", o.tests},
      {"one_side", o.one_side},
      {"seed", o.seed},
      {"mean_um", stable(to_um(study.mean))},
      {"largest_um", stable(to_um(study.largest))},
      {"poses", Json::array()}};
  for (const auto& pose : study.poses)
    json["poses"].push_back({{"x_mm", stable(to_mm(pose.position.x()))},
                             {"y_mm", stable(to_mm(pose.position.y()))},
                             {"z_mm", stable(to_mm(pose.position.z()))},
                             {"repeatability_um", stable(to_um(pose.repeatability))}});
  json["command"] = o.command;
  json["version"] = kVersion;
  return to_text(json, 2) + "\n";
}

std::string repeatability_table(const studies::Repeatability& study) {
  std::string text = fmt::format("{}: repeatability of position (ISO 9283), {} tests of {} approaches\n\n",
                                 study.machine, study.options.tests, study.options.cycles);
  text += "       x        y        z   repeatability\n      mm       mm       mm              um\n";
  for (const auto& pose : study.poses)
    text += fmt::format("{:8.1f} {:8.1f} {:8.1f} {:15.1f}\n", to_mm(pose.position.x()),
                        to_mm(pose.position.y()), to_mm(pose.position.z()), to_um(pose.repeatability));
  return text + fmt::format("\nmean {:.1f} um, largest {:.1f} um", to_um(study.mean), to_um(study.largest));
}

}  // namespace understudy::report
