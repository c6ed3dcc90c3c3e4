#include "report/page/replay_page.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "report/chart/svg_chart.h"
#include "report/markup.h"
#include "report/page/page_parts.h"
#include "report/replay_report.h"

namespace understudy::report {
namespace {

using rehearsal::AxisDifference;
using rehearsal::MeasuredSide;
using rehearsal::ReplayedRecord;
using rehearsal::ReplayedRow;

constexpr std::size_t kPoints = 600;  // of a line: as many as the drawing has pixels

/// Of each stretch of rows the one that is farthest off, so that no peak is lost.
std::vector<ChartPoint> thinned(const std::vector<ReplayedRow>& rows, std::size_t axis, bool angle) {
  const std::size_t stretch = std::max<std::size_t>(1, rows.size() / kPoints);
  std::vector<ChartPoint> points;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const ChartPoint point{rows[k].time, shown_difference(rows[k].machine[axis] - rows[k].twin[axis], angle)};
    if (k % stretch == 0)
      points.push_back(point);
    else if (std::abs(point.y) > std::abs(points.back().y))
      points.back() = point;
  }
  return points;
}

/// Axes of one unit on one side.
std::string difference_chart(const ReplayedRecord& replay, const std::vector<ReplayedRow>& rows, bool angle) {
  std::vector<std::vector<ChartPoint>> lines(replay.axis_names.size());
  double top = angle ? 0.01 : 1;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (replay.axis_angles[i] != angle) continue;
    lines[i] = thinned(rows, i, angle);
    for (const ChartPoint& point : lines[i]) top = std::max(top, std::abs(point.y));
  }
  SvgChart plot({}, Scale::linear(rows.front().time, std::max(rows.front().time + 1e-3, rows.back().time)),
                Scale::linear(-1.05 * top, 1.05 * top));
  plot.y_axis(angle ? "machine less twin, arcmin" : "machine less twin, µm");
  plot.x_axis("s");
  int place = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].empty()) continue;
    plot.key(place++, series_colour(i), html_text(replay.axis_names[i]));
    plot.line(lines[i], fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"1.2\"", series_colour(i)));
  }
  return plot.finish();
}

std::string charts(const ReplayedRecord& replay, const std::vector<ReplayedRow>& rows, const char* caption) {
  std::string out;
  for (const bool angle : {false, true})
    if (!rows.empty() &&
        std::find(replay.axis_angles.begin(), replay.axis_angles.end(), angle) != replay.axis_angles.end())
      out += fmt::format("<figure>{}<figcaption>{}</figcaption></figure>",
                         difference_chart(replay, rows, angle), caption);
  return out;
}

std::string table(const ReplayedRecord& replay) {
  std::string out =
      "<table><thead><tr><th>axis</th><th>measured</th><th class=\"number\">mean</th><th "
      "class=\"number\">RMS</th><th class=\"number\">largest</th><th class=\"number\">agreed</th><th>unit"
      "</th><th class=\"number\">at, s</th><th class=\"number\">line</th><th></th></tr></thead><tbody>";
  for (const AxisDifference& d : replay.differences) {
    const auto cell = [&](double value) {
      return fmt::format("<td class=\"number\">{:.1f}</td>", shown_difference(value, d.angle));
    };
    out += fmt::format(
        "<tr><td>{}</td><td>{}</td>{}{}{}{}<td>{}</td><td class=\"number\">{:.3f}</td><td "
        "class=\"number\">{}</td><td>{}</td></tr>",
        html_text(d.axis), d.side == MeasuredSide::drive ? "by the drive" : "behind the play", cell(d.mean),
        cell(d.rms), cell(d.largest), cell(d.agreed), d.angle ? "arcmin" : "µm", d.time, d.line,
        d.agrees() ? "" : "<span class=\"severity error\">apart</span>");
  }
  return out + "</tbody></table>";
}

std::string notes(const ReplayedRecord& replay) {
  std::string out;
  for (const std::string& note : replay.notes) out += "<p class=\"note\">" + html_text(note) + "</p>";
  if (!replay.stopped.empty())
    out += "<p><span class=\"severity error\">stopped</span> " + html_text(replay.stopped) + "</p>";
  return out;
}

}  // namespace

std::string replay_html(const ReplayedRecord& replay) {
  const std::string title =
      html_text(fmt::format("{}: {}", std::filesystem::path(replay.record).filename().string(),
                            replay.agrees() ? "the twin agrees" : "the twin does not agree"));
  return fmt::format(
      "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width\"><title>{0}</title><style>{1}</style></head><body><main><p "
      "class=\"eyebrow\">Understudy replay of {2}, as built {3}, {4}</p><h1>{0}</h1>{5}<section><h2>"
      "Positions</h2>{6}<div class=\"pictures\">{7}{8}</div></section><section><h2>How to repeat it</h2>"
      "<code>{9}</code></section></main></body></html>\n",
      title, kPageStyle, html_text(replay.machine), html_text(replay.as_built), html_text(replay.engine),
      notes(replay), table(replay),
      charts(replay, replay.drive_rows, "Positions that the drives measured, less the twin's."),
      charts(replay, replay.load_rows, "Positions behind the play, less the twin's."),
      html_text(replay.command));
}

}  // namespace understudy::report
