#include "report/replay_report.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/text/stable_number.h"
#include "core/units.h"
#include "core/version.h"
#include "report/json_text.h"

namespace understudy::report {
namespace {

using rehearsal::AxisDifference;
using rehearsal::MeasuredSide;
using rehearsal::ReplayedRecord;
using rehearsal::ReplayedRow;
using Json = nlohmann::ordered_json;

double stable(double value) { return stable_number(value, "replay"); }

const char* side_words(MeasuredSide side) {
  return side == MeasuredSide::drive ? "as the drives measure" : "behind the play";
}

/// The largest beyond its limit, in limits.
const AxisDifference* worst_of(const ReplayedRecord& replay) {
  const AxisDifference* worst = nullptr;
  for (const AxisDifference& d : replay.differences)
    if (!d.agrees() &&
        (worst == nullptr || std::abs(d.largest) / d.agreed > std::abs(worst->largest) / worst->agreed))
      worst = &d;
  return worst;
}

std::string answer_of(const ReplayedRecord& replay) {
  if (!replay.stopped.empty()) return replay.stopped;
  const AxisDifference* worst = worst_of(replay);
  if (worst == nullptr) return "the twin agrees with the machine";
  const auto shown = [&](double value) { return shown_difference(value, worst->angle); };
  return fmt::format(
      "the twin does not agree: {} is {:.1f} {} off {}, at {:.3f} s, line {}; {:.1f} are agreed", worst->axis,
      shown(std::abs(worst->largest)), difference_unit(worst->angle), side_words(worst->side), worst->time,
      worst->line, shown(worst->agreed));
}

void add_rows(const ReplayedRecord& replay, const std::vector<ReplayedRow>& rows, const char* side,
              std::string& out) {
  for (const ReplayedRow& row : rows) {
    out += fmt::format("{},{:.6f},{}", side, row.time, row.line);
    for (std::size_t i = 0; i < replay.axis_names.size(); ++i) {
      const double unit = replay.axis_angles[i] ? kDegree : kMillimetre;
      out += fmt::format(",{:.6f},{:.6f}", row.machine[i] / unit, row.twin[i] / unit);
    }
    out += '\n';
  }
}

}  // namespace

double shown_difference(double difference, bool angle) {
  return angle ? 60 * to_deg(difference) : to_um(difference);
}

const char* difference_unit(bool angle) { return angle ? "arcmin" : "um"; }

std::string replay_text(const ReplayedRecord& replay) {
  std::string out = fmt::format("{} on {}, as built {}, {}: {}\n", replay.record, replay.machine,
                                replay.as_built, replay.engine, answer_of(replay));
  for (const std::string& note : replay.notes) out += "  note: " + note + "\n";
  out += "  machine less twin    mean      RMS   largest   agreed  at s      line\n";
  for (const AxisDifference& d : replay.differences) {
    const auto shown = [&](double value) { return shown_difference(value, d.angle); };
    out += fmt::format("  {:6} {:5} {:6} {:6.1f} {:8.1f}  {:8.1f} {:8.1f}  {:<8.3f}  {:<6}{}\n", d.axis,
                       to_string(d.side), difference_unit(d.angle), shown(d.mean), shown(d.rms),
                       shown(d.largest), shown(d.agreed), d.time, d.line, d.agrees() ? "" : " apart");
  }
  return out;
}

std::string replay_json(const ReplayedRecord& replay) {
  Json json{{"schema", "understudy.replay/1"}, {"record", replay.record},
            {"machine", replay.machine},       {"as_built", replay.as_built},
            {"engine", replay.engine},         {"agrees", replay.agrees()},
            {"answer", answer_of(replay)},     {"record_whole", replay.whole},
            {"notes", replay.notes},           {"axes", Json::array()}};
  for (const AxisDifference& d : replay.differences) {
    const std::string unit = std::string("_") + difference_unit(d.angle);
    const auto put = [&](Json& axis, const char* key, double value) {
      axis[key + unit] = stable(shown_difference(value, d.angle));
    };
    Json axis{{"axis", d.axis}, {"side", to_string(d.side)}};
    put(axis, "mean", d.mean);
    put(axis, "rms", d.rms);
    put(axis, "largest", d.largest);
    put(axis, "agreed", d.agreed);
    axis["largest_at_s"] = stable(d.time);
    axis["largest_at_line"] = d.line;
    axis["agrees"] = d.agrees();
    json["axes"].push_back(axis);
  }
  json["command"] = replay.command;
  json["version"] = kVersion;
  return to_text(json, 2) + "\n";
}

std::string replay_csv(const ReplayedRecord& replay) {
  std::string out = "side,time_s,line";
  for (std::size_t i = 0; i < replay.axis_names.size(); ++i) {
    const char* unit = replay.axis_angles[i] ? "deg" : "mm";
    out += fmt::format(",{0}_machine_{1},{0}_twin_{1}", replay.axis_names[i], unit);
  }
  out += '\n';
  add_rows(replay, replay.drive_rows, "drive", out);
  add_rows(replay, replay.load_rows, "load", out);
  return out;
}

}  // namespace understudy::report
