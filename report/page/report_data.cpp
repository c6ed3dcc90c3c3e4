#include "report/page/report_data.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "core/text/stable_number.h"
#include "core/units.h"
#include "rehearsal/findings/verdict.h"
#include "report/page/over_time.h"
#include "report/page/replay_data.h"
#include "report/picture/png.h"
#include "report/summary_json.h"
#include "report/trace/trace_values.h"

namespace understudy::report {
namespace {

using rehearsal::AxisColumn;
using rehearsal::FrameRecord;
using rehearsal::Record;
using rehearsal::StrandRow;
using rehearsal::TracePoint;
using Json = nlohmann::ordered_json;

// A chart is about a thousand pixels wide: two points a pixel, extremes kept, hide nothing and keep the page
// small.
constexpr std::size_t kChartPoints = 2000;
constexpr int kTraceDigits = 8;

std::string data_uri(const std::string& png) { return "data:image/png;base64," + base64(png); }

Json pixel(const Vec2& p) { return {stable_number(p.x(), "pixel x"), stable_number(p.y(), "pixel y")}; }

Json names_value(const Record& record) {
  Json names = Json::object();
  const auto put = [&](const char* key, const std::string& name) {
    if (!name.empty()) names[key] = name;
  };
  put("program", record.program_name);
  put("machine", record.machine_name);
  put("fixture", record.fixture_name);
  put("gap_control", record.gap_control);
  put("seed", std::to_string(record.provenance.seed));  // JavaScript's numbers hold 53 bits only
  return names;
}

Json axes_value(const Record& record) {
  Json axes = Json::array();
  for (const AxisColumn& column : record.axes) {
    const bool angle = column.name.ends_with("_deg");
    const auto in_file_units = [&](double v) { return angle ? to_deg(v) : to_mm(v); };
    Json axis;
    axis["name"] = column.name;
    if (column.min) axis["min"] = stable_number(in_file_units(*column.min), "axis min");
    if (column.max) axis["max"] = stable_number(in_file_units(*column.max), "axis max");
    axes.push_back(axis);
  }
  return axes;
}

/// To the decimals of trace.csv: what is smaller is rounding, and not the same on every processor.
double shown(double value, const std::string& column) {
  const double unit = std::pow(10.0, column_decimals(column));
  return stable_number(std::round(value * unit) / unit, column.c_str(), kTraceDigits);
}

Json trace_value(const std::vector<TracePoint>& trace, const Record& record) {
  const std::vector<std::string> columns = trace_columns(record);
  std::vector<Json> values(columns.size(), Json::array());
  std::vector<double> row;
  for (const std::size_t i : thin_out(trace, kChartPoints)) {
    trace_row(trace[i], record, columns, row);
    for (std::size_t c = 0; c < row.size(); ++c) {
      const bool whole = columns[c] == "line" || columns[c] == "extruding";
      if (!std::isfinite(row[c]))
        values[c].push_back(nullptr);  // nothing below the tip
      else if (whole)
        values[c].push_back(static_cast<int>(row[c]));
      else
        values[c].push_back(shown(row[c], columns[c]));
    }
  }
  Json object;
  object["points"] = trace.size();
  for (std::size_t c = 0; c < columns.size(); ++c) object["columns"][columns[c]] = std::move(values[c]);
  return object;
}

/// What the controller believed at the points that the trace's columns show.
void put_beliefs(const Record& record, Json& trace) {
  Json gap = Json::array(), sigma = Json::array();
  for (const std::size_t i : thin_out(record.trace, kChartPoints)) {
    const auto& [held, stated] = record.gap_beliefs[i];
    gap.push_back(shown(to_mm(held), "believed_gap_mm"));
    sigma.push_back(std::isfinite(stated) ? Json(shown(to_um(stated), "stated_sigma_um")) : Json());
  }
  trace["columns"]["believed_gap_mm"] = std::move(gap);
  trace["columns"]["stated_sigma_um"] = std::move(sigma);
}

Json frame_value(const FrameRecord& frame) {
  const control::GapSample& look = frame.look;
  const Image& image = look.frame.image;
  Json object;
  object["time_s"] = stable_number(look.time, "frame time");
  object["used"] = look.used;
  if (!look.why.empty()) object["why"] = look.why;
  object["dot"] = vision::to_string(look.dot.status);
  if (look.dot.status != vision::DotStatus::no_dot) object["measured_px"] = pixel(look.dot.position_px);
  if (frame.true_dot_px) object["true_px"] = pixel(*frame.true_dot_px);
  if (look.reading.sigma > 0) {  // a look that could not be inverted has none
    object["reading_mm"] = stable_number(to_mm(look.reading.gap), "reading");
    object["sigma_um"] = stable_number(to_um(look.reading.sigma), "sigma");
    object["residual_px"] = stable_number(look.reading.residual_px, "residual");
  }
  if (std::isfinite(frame.true_gap)) object["true_gap_mm"] = stable_number(to_mm(frame.true_gap), "true gap");
  if (!image.pixels.empty()) {
    object["region"] = {image.region.x, image.region.y, image.region.width, image.region.height};
    object["image"] = data_uri(encode_png(image));
  }
  return object;
}

Json picture_value(const Illustration& illustration) {
  Json object;
  if (!illustration.caption.empty()) object["caption"] = illustration.caption;
  object["width"] = illustration.width;
  object["height"] = illustration.height;
  object["image"] = data_uri(illustration.png);
  return object;
}

constexpr std::size_t kStrandsShown = 50;

Json strands_value(const std::vector<StrandRow>& strands) {
  Json rows = Json::array();
  for (const StrandRow& strand : strands) {
    if (rows.size() == kStrandsShown) break;
    Json row;
    row["line"] = strand.line;
    row["time_s"] = stable_number(strand.time_s, "strand time");
    row["length_mm"] = stable_number(strand.length_mm, "strand length");
    row["diameter_mm"] = stable_number(strand.diameter_mm, "strand diameter");
    row["speed_mm_per_s"] = stable_number(strand.speed_mm_per_s, "strand speed");
    if (strand.solved) row["sag_um"] = stable_number(strand.sag_um, "sag");
    row["solid_after_s"] = stable_number(strand.solid_after_s, "strand solid");
    row["duration_s"] = stable_number(strand.duration_s, "strand duration");
    row["held_at_end"] = strand.held_at_end;
    row["small"] = strand.small;
    rows.push_back(row);
  }
  return rows;
}

constexpr std::size_t kFramesShown =
    60;  // more come from following a path: those with pictures stand for them

Json profile_value(const Record& record) {
  Json object;
  object["note"] = record.profile_note;
  object["position_mm"] = object["height_um"] = Json::array();
  for (const auto& [position, height] : record.profile) {
    object["position_mm"].push_back(stable_number(position, "profile position"));
    object["height_um"].push_back(stable_number(height, "profile height"));
  }
  return object;
}

}  // namespace

Json report_data(const rehearsal::Record& record) {
  Json report;
  report["schema"] = "understudy.report/1";
  report["title"] = record.title;
  report["reason"] = rehearsal::verdict_sentence(record);
  report["names"] = names_value(record);
  report["summary"] = summary_value(record);
  if (record.gap_accepted_max_mm > 0)
    report["gap_band"] = {{"min_mm", stable_number(record.gap_accepted_min_mm, "gap band min")},
                          {"max_mm", stable_number(record.gap_accepted_max_mm, "gap band max")},
                          {"aim_mm", stable_number(record.gap_aim_mm, "gap aim")}};
  report["axes"] = axes_value(record);
  if (!record.trace.empty()) report["trace"] = trace_value(record.trace, record);
  if (!record.trace.empty() && record.gap_beliefs.size() == record.trace.size())
    put_beliefs(record, report["trace"]);
  if (!record.gap_belief_note.empty()) report["gap_belief_note"] = record.gap_belief_note;
  if (!record.trace_without_gap_control.empty())
    report["trace_without_gap_control"] = trace_value(record.trace_without_gap_control, record);
  if (!record.trace_before_calibration.empty())
    report["trace_before_calibration"] = trace_value(record.trace_before_calibration, record);
  if (record.trace_stride > 1) report["trace_stride"] = record.trace_stride;
  if (Json curves = over_time(record); !curves.is_null()) report["over_time"] = std::move(curves);
  if (!record.strands.empty()) report["strands"] = strands_value(record.strands);
  if (!record.profile.empty()) report["profile"] = profile_value(record);
  if (!record.deviation_note.empty()) report["deviation_note"] = record.deviation_note;
  if (Json replay = replay_data(record); !replay.is_null()) report["replay"] = std::move(replay);
  report["frames"] = Json::array();
  const bool all_frames = record.frames.size() <= kFramesShown;
  for (const FrameRecord& frame : record.frames)
    if (all_frames || !frame.look.frame.image.pixels.empty()) report["frames"].push_back(frame_value(frame));
  return report;
}

Json pictures_value(const std::vector<Illustration>& pictures) {
  Json values = Json::array();
  for (const Illustration& picture : pictures) values.push_back(picture_value(picture));
  return values;
}

}  // namespace understudy::report
