#include "report/page/calibration_benchmark_page.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/units.h"
#include "core/version.h"
#include "report/chart/svg_chart.h"
#include "report/markup.h"
#include "report/page/page_parts.h"

namespace understudy::report {
namespace {

using namespace studies;

const char* colour(std::size_t entrant) { return series_colour(entrant); }

std::string um(double metres) { return std::isfinite(metres) ? fmt::format("{:.1f}", to_um(metres)) : "–"; }

const char* described(Disturbance d, bool pixels) {
  switch (d) {
    case Disturbance::none:
      return "nothing but noise";
    case Disturbance::outliers:
      return "outliers: an eighth of the poses off by 1 mm and 10 mrad";
    case Disturbance::boards:
      return pixels ? "boards misplaced by 0.2 mm and 2 mrad"
                    : "boards: the measuring frame off by 50 µm, 0.5 mrad and 0.05 %";
    case Disturbance::play:
      return "play in every joint, approached from both sides";
    case Disturbance::deviation:
      return "deviation: dev 1 mm smaller than believed";
    case Disturbance::drift:
      return "drift: screws warm by 20 K during the measurement";
  }
  return "";
}

/// Conditions that differ in the number of poses only.
using Family = std::vector<const ConditionScore*>;

std::vector<Family> families(const CalibrationBenchmark& benchmark) {
  std::vector<Family> all;
  for (const ConditionScore& c : benchmark.conditions) {
    const auto same = [&](const Family& f) {
      const studies::Condition& a = f.front()->condition;
      return a.disturbance == c.condition.disturbance && a.noise.position == c.condition.noise.position &&
             a.noise.rotation == c.condition.noise.rotation;
    };
    const auto found = std::find_if(all.begin(), all.end(), same);
    if (found == all.end())
      all.push_back({&c});
    else
      found->push_back(&c);
  }
  return all;
}

Scale error_scale(const CalibrationBenchmark& benchmark) {
  double low = 1e300, high = 0;
  for (const ConditionScore& c : benchmark.conditions) {
    high = std::max(high, to_um(c.uncalibrated));
    if (c.bound > 0) low = std::min(low, to_um(c.bound));
    for (const EntrantScore& s : c.scores) {
      if (!std::isfinite(s.median)) continue;
      low = std::min(low, to_um(s.median));
      high = std::max(high, to_um(s.p95));
    }
  }
  low = std::pow(10, std::floor(std::log10(std::min(low, high))));
  return Scale::logarithmic(low, std::max(10 * low, 1.1 * high));
}

/// Medians of one entrant, each with its figures.
void draw_entrant(const CalibrationBenchmark& benchmark, const Family& family, std::size_t e,
                  SvgChart& plot) {
  // Entrants that agree would hide each other.
  const double aside =
      4 * (static_cast<double>(e) - 0.5 * static_cast<double>(benchmark.entrants.size() - 1));
  std::vector<ChartPoint> points;
  for (const ConditionScore* c : family) {
    const EntrantScore& s = c->scores[e];
    if (!std::isfinite(s.median)) continue;
    points.push_back({static_cast<double>(c->condition.poses), to_um(s.median), aside});
    plot.dot(points.back(), colour(e),
             fmt::format("{}, {} poses: {} µm, p95 {} µm", benchmark.entrants[e].name, c->condition.poses,
                         um(s.median), um(s.p95)));
  }
  plot.line(points, fmt::format("stroke=\"{}\" stroke-width=\"1.5\" opacity=\"0.7\"", colour(e)));
}

std::string chart(const CalibrationBenchmark& benchmark, const Family& family, const Scale& y) {
  double fewest = 1e9, most = 0;
  for (const ConditionScore* c : family) {
    fewest = std::min(fewest, static_cast<double>(c->condition.poses));
    most = std::max(most, static_cast<double>(c->condition.poses));
  }
  SvgChart plot({.width = 520, .left = 64, .top = 12}, Scale::logarithmic(0.85 * fewest, 1.15 * most), y);
  plot.y_axis("tip error, median [µm]");
  plot.x_name("poses");
  std::vector<ChartPoint> bound, before;
  for (const ConditionScore* c : family) {
    const auto at = static_cast<double>(c->condition.poses);
    plot.x_tick(at, fmt::format("{}", c->condition.poses));
    if (c->bound > 0) bound.push_back({at, to_um(c->bound)});
    before.push_back({at, to_um(c->uncalibrated)});
  }
  plot.line(bound, "stroke=\"#5a6570\" stroke-dasharray=\"5 4\"");
  plot.line(before, "stroke=\"#5a6570\" stroke-dasharray=\"1 4\" stroke-width=\"2\"");
  for (std::size_t e = 0; e < benchmark.entrants.size(); ++e) draw_entrant(benchmark, family, e, plot);
  const studies::Condition& c = family.front()->condition;
  const bool pixels = benchmark.request.from == MeasuredFrom::pixels;
  std::string caption = described(c.disturbance, pixels);
  if (!pixels)
    caption += fmt::format(", {:g} µm and {:g} mrad", to_um(c.noise.position), 1e3 * c.noise.rotation);
  return fmt::format("<figure>{}<figcaption>{}</figcaption></figure>\n", plot.finish(), caption);
}

std::string ranking(const CalibrationBenchmark& benchmark) {
  std::string rows;
  int place = 0;
  for (const Standing& s : benchmark.ranking)
    rows += fmt::format(
        "<tr><td class=\"number\">{}</td><td><span style=\"color:{}\">&#9679;</span> {}{}</td>"
        "<td class=\"number\">{:.3f}</td><td class=\"number\">{} of {}</td></tr>\n",
        ++place, colour(s.entrant), html_text(benchmark.entrants[s.entrant].name),
        benchmark.entrants[s.entrant].plugin ? " (plug-in)" : "", s.score, s.failures, s.runs);
  return "<table><thead><tr><th class=\"number\">place</th><th>entrant</th><th class=\"number\">score</th>"
         "<th class=\"number\">failed</th></tr></thead><tbody>\n" +
         rows + "</tbody></table>\n";
}

std::string reasons_text(const EntrantScore& score) {
  std::string text;
  for (const auto& [reason, count] : score.reasons)
    text += fmt::format("{}{} × {}", text.empty() ? "" : "; ", count, html_text(reason));
  return text;
}

/// On the plant: errors against what was stated of them.
std::string stated(const CalibrationBenchmark& benchmark, const ConditionScore& c) {
  std::string rows;
  const auto cell = [](double value, int digits) {
    return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : std::string("–");
  };
  for (std::size_t e = 0; e < c.scores.size(); ++e)
    for (const auto& [frame, score] :
         {std::pair{"W", c.scores[e].in_frame}, std::pair{"registered", c.scores[e].registered}})
      rows += fmt::format(
          "<tr><td>{}</td><td>{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td>"
          "<td class=\"number\">{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td></tr>\n",
          html_text(benchmark.entrants[e].name), frame, cell(to_um(score.median), 1),
          cell(to_um(score.worst), 1), cell(score.ratio, 2), cell(score.chi_square, 2),
          cell(1e2 * score.coverage, 1));
  return "<table><thead><tr><th>entrant</th><th>frame</th><th class=\"number\">median µm</th>"
         "<th class=\"number\">worst µm</th><th class=\"number\">error over stated</th>"
         "<th class=\"number\">chi-square</th><th class=\"number\">within 95 %, "
         "%</th></tr></thead><tbody>\n" +
         rows + "</tbody></table>\n";
}

std::string figures(const CalibrationBenchmark& benchmark, const ConditionScore& c) {
  std::string name = to_string(c.condition, benchmark.request.from);
  if (const auto unit = name.find(" um "); unit != std::string::npos) name.replace(unit, 4, " µm ");
  std::string rows;
  for (std::size_t e = 0; e < c.scores.size(); ++e) {
    const EntrantScore& s = c.scores[e];
    rows += fmt::format(
        "<tr><td>{}{}{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td>"
        "<td class=\"number\">{}</td><td class=\"number\">{}</td><td class=\"number\">{:.2f}</td>"
        "<td class=\"number\">{}</td><td>{}</td></tr>\n",
        e == c.best ? "<strong>" : "", html_text(benchmark.entrants[e].name), e == c.best ? "</strong>" : "",
        um(s.median), um(s.p95), um(s.rms),
        std::isfinite(s.efficiency) ? fmt::format("{:.2f}", s.efficiency) : "–", 1e3 * s.seconds, s.failures,
        reasons_text(s));
  }
  return fmt::format(
      "<details><summary>{}: as built {} µm{}{}</summary><table><thead><tr><th>entrant</th>"
      "<th class=\"number\">median µm</th><th class=\"number\">p95 µm</th>"
      "<th class=\"number\">RMS µm</th><th class=\"number\">efficiency</th>"
      "<th class=\"number\">time ms</th><th class=\"number\">failed</th><th>why</th></tr></thead>"
      "<tbody>\n{}</tbody></table>{}</details>\n",
      name, um(c.uncalibrated), c.bound > 0 ? fmt::format(", bound {} µm", um(c.bound)) : "",
      c.lost_poses > 0 ? fmt::format(", {} poses not measured", c.lost_poses) : "", rows,
      benchmark.request.engine.empty() ? "" : stated(benchmark, c));
}

}  // namespace

std::string benchmark_page(const CalibrationBenchmark& benchmark) {
  const bool pixels = benchmark.request.from == MeasuredFrom::pixels;
  const std::string title = fmt::format("Calibration benchmark: {}", html_text(benchmark.machine_name));
  std::string charts, tables;
  const Scale y = error_scale(benchmark);
  for (const Family& family : families(benchmark)) charts += chart(benchmark, family, y);
  for (const ConditionScore& c : benchmark.conditions) tables += figures(benchmark, c);
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{}</title>\n"
      "<meta name=\"viewport\" content=\"width=device-width\">\n<style>{}\nsvg {{ width: 100%; height: auto; "
      "fill: #1c2329; }}</style></head><body><main>\n<p class=\"eyebrow\">Understudy {}</p><h1>{}</h1>\n"
      "<p>{} built machines, seed {}, measured from {}. Errors are those of the tip at 60 poses held "
      "out.</p>\n"
      "<section><h2>Ranking</h2><p class=\"note\">Score: median tip error over that of the best entrant, "
      "geometric mean over all conditions. A failed problem counts as no calibration.</p>{}</section>\n"
      "<section><h2>Tip error</h2><p class=\"note\">Dotted: as built. Dashed: the Cramér-Rao bound (RMS) of "
      "the "
      "unknowns that the machine has, for the noise alone. Points stand side by side; rest on one for its "
      "figures.</p><div class=\"pictures\">{}</div></section>\n"
      "<section><h2>All figures</h2><p class=\"note\">Times are wall times of one problem (median); all "
      "other "
      "figures depend on the seed alone.</p>{}</section>\n"
      "<section><h2>Run</h2><p><code>{}</code></p><p class=\"note\">machine sha256 {}</p></section>\n"
      "</main></body></html>\n",
      title, kPageStyle, kVersion, title, benchmark.request.trials, benchmark.request.seed,
      pixels ? "rendered pictures" : "poses with noise", ranking(benchmark), charts, tables,
      html_text(benchmark.request.command), benchmark.machine_sha256);
}

}  // namespace understudy::report
