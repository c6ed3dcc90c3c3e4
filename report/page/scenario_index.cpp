#include "report/page/scenario_index.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/version.h"
#include "report/chart/svg_drawing.h"
#include "report/markup.h"
#include "report/page/page_parts.h"

namespace understudy::report {
namespace {

using regression::Check;

constexpr std::size_t kRunsShown = 30;
constexpr std::size_t kChangesShown = 12;

constexpr const char* kStyle = R"(
.scenario { display: grid; grid-template-columns: 220px minmax(0, 1fr); gap: 8px 24px; padding: 20px 0; border-top: 1px solid var(--line); }
.scenario img { width: 220px; height: auto; border: 1px solid var(--line); border-radius: 4px; }
.scenario h2 { margin: 0; overflow-wrap: anywhere; }
.ok { color: var(--go); } .fail { color: var(--no-go); font-weight: 600; }
.checks td:first-child { width: 4em; } .checks td { overflow-wrap: break-word; }
.scenario p:not(.note) { margin: 8px 0 4px; }
.checks .trend { width: 130px; }
.overview td, .overview th { white-space: nowrap; } .overview td:first-child { white-space: normal; }
@media (max-width: 640px) { .scenario { grid-template-columns: minmax(0, 1fr); } .overview .wide { display: none; } }
)";

std::string mark(bool passed) {
  return passed ? "<span class=\"ok\">pass</span>" : "<span class=\"fail\">FAIL</span>";
}

std::vector<const PastScenario*> past_of(std::span<const PastRun> history, const std::string& name) {
  std::vector<const PastScenario*> past;
  for (const PastRun& run : history.last(std::min(history.size(), kRunsShown - 1)))
    if (const auto found = run.scenarios.find(name); found != run.scenarios.end())
      past.push_back(&found->second);
  return past;
}

/// A square a run, the last one this run.
std::string verdicts_drawing(const std::vector<const PastScenario*>& past,
                             const regression::ScenarioResult& now) {
  constexpr double kStep = 9, kSide = 7;
  SvgDrawing drawing(kStep * static_cast<double>(past.size() + 1), kSide, "height:7px;width:auto");
  double x = 0;
  const auto square = [&](bool passed) {
    drawing.rect({x, 0}, {kSide, kSide}, passed ? "fill=\"#00694d\"" : "fill=\"#a33b00\"",
                 passed ? "passed" : "failed");
    x += kStep;
  };
  for (const PastScenario* each : past) square(each->passed);
  square(now.passed());
  return drawing.finish();
}

/// The check's value over the runs, with its bounds as dashed lines; empty without an earlier one.
std::string trend_drawing(const std::vector<const PastScenario*>& past, const Check& check) {
  if (!check.value || !std::holds_alternative<double>(*check.value)) return "";
  std::vector<double> values;
  for (const PastScenario* each : past)
    if (const auto found = each->values.find(check.name); found != each->values.end())
      values.push_back(found->second);
  if (values.empty()) return "";
  values.push_back(std::get<double>(*check.value));
  const double least = std::ranges::min(values), most = std::ranges::max(values);
  constexpr double kWidth = 120, kHeight = 24, kMargin = 3;
  const double span = most > least ? most - least : 1;
  const auto y = [&](double value) {
    return kHeight - kMargin - (value - least) / span * (kHeight - 2 * kMargin);
  };
  SvgDrawing drawing(kWidth, kHeight, "width:120px;height:24px");
  for (const auto& bound : {check.expectation.min, check.expectation.max})
    if (bound && *bound >= least && *bound <= most)
      drawing.line({0, y(*bound)}, {kWidth, y(*bound)}, "stroke=\"#a33b00\" stroke-dasharray=\"3 3\"");
  std::vector<SvgPoint> points;
  for (std::size_t i = 0; i < values.size(); ++i)
    points.push_back(
        {kMargin + (kWidth - 2 * kMargin) * static_cast<double>(i) / static_cast<double>(values.size() - 1),
         most > least ? y(values[i]) : kHeight / 2});
  drawing.polyline(points, "fill=\"none\" stroke=\"#005b8f\" stroke-width=\"1.5\"");
  drawing.circle(points.back(), 2, check.ok ? "fill=\"#005b8f\"" : "fill=\"#a33b00\"",
                 fmt::format("{:.6g} to {:.6g} in {} runs", least, most, values.size()));
  return drawing.finish();
}

/// Dotted names may break after a dot or an underscore, numbers not.
std::string breakable(const std::string& name) {
  const std::string text = html_text(name);
  const auto letter = [&](std::size_t i) { return i < text.size() && text[i] >= 'a' && text[i] <= 'z'; };
  std::string html;
  for (std::size_t i = 0; i < text.size(); ++i) {
    html += text[i];
    if ((text[i] == '.' || text[i] == '_') && letter(i + 1)) html += "<wbr>";
  }
  return html;
}

std::string checks_table(const IndexedScenario& scenario, const std::vector<const PastScenario*>& past) {
  std::string html =
      "<table class=\"checks\"><thead><tr><th></th><th>expected</th><th class=\"number\">value</th>"
      "<th>source</th><th class=\"trend\">earlier runs</th></tr></thead><tbody>\n";
  for (const Check& check : scenario.result.checks)
    html += fmt::format(
        "<tr><td>{}</td><td>{}</td><td class=\"number\">{}</td><td>{}</td><td class=\"trend\">{}</td></tr>\n",
        mark(check.ok), breakable(check.name),
        html_text(regression::text_of(check.value, check.expectation.unit)),
        html_text(check.expectation.source), trend_drawing(past, check));
  return html + "</tbody></table>\n";
}

std::string changes_list(const IndexedScenario& scenario) {
  if (scenario.changes.empty()) return "";
  std::string html = fmt::format("<details open><summary>{} figures differ from the baseline</summary><ul>",
                                 scenario.changes.size());
  const std::size_t shown = std::min(scenario.changes.size(), kChangesShown);
  for (std::size_t i = 0; i < shown; ++i)
    html += "<li>" + html_text(regression::text_of(scenario.changes[i])) + "</li>";
  if (scenario.changes.size() > shown)
    html += fmt::format("<li>and {} more</li>", scenario.changes.size() - shown);
  return html + "</ul></details>\n";
}

std::string scenario_section(const IndexedScenario& scenario, std::span<const PastRun> history) {
  const auto past = past_of(history, scenario.result.name);
  const std::string name = html_text(scenario.result.name);
  const std::string folder = html_text(scenario.folder);
  std::string html = fmt::format("<article class=\"scenario\" id=\"{}\"><div>", name);
  if (!scenario.picture.empty())
    html +=
        fmt::format("<a href=\"{}/report.html\"><img src=\"{}\" alt=\"picture of {}\" loading=\"lazy\"></a>",
                    folder, html_text(scenario.picture), name);
  html += fmt::format("</div><div><h2>{} {}</h2><p class=\"note\">{}</p>\n", mark(scenario.result.passed()),
                      name, html_text(scenario.description));
  if (!scenario.result.error.empty())
    html += "<p class=\"fail\">" + html_text(scenario.result.error) + "</p>\n";
  if (!scenario.result.checks.empty()) html += checks_table(scenario, past);
  html += changes_list(scenario);
  if (!scenario.folder.empty()) html += fmt::format("<p><a href=\"{}/report.html\">Report</a></p>\n", folder);
  html += "<p class=\"note\">Alone: <code>" + html_text(scenario.replay) + "</code></p></div></article>\n";
  return html;
}

std::string overview(std::span<const IndexedScenario> scenarios, std::span<const PastRun> history) {
  std::string html =
      "<table class=\"overview\"><thead><tr><th>scenario</th><th></th><th class=\"number\">time</th>"
      "<th class=\"wide\">earlier runs, and this one</th></tr></thead><tbody>\n";
  for (const IndexedScenario& scenario : scenarios) {
    const auto& result = scenario.result;
    html += fmt::format(
        "<tr><td><a href=\"#{0}\">{0}</a></td><td class=\"scenario-mark\">{1}</td><td "
        "class=\"number\">{2:.1f} s</td>"
        "<td class=\"wide\">{3}</td></tr>\n",
        html_text(result.name), mark(result.passed()), result.seconds.value_or(0),
        verdicts_drawing(past_of(history, result.name), result));
  }
  return html + "</tbody></table>\n";
}

}  // namespace

std::string scenario_index_html(std::span<const IndexedScenario> scenarios,
                                std::span<const PastRun> history) {
  const auto failed =
      std::ranges::count_if(scenarios, [](const IndexedScenario& s) { return !s.result.passed(); });
  const auto passed = static_cast<std::ptrdiff_t>(scenarios.size()) - failed;
  std::string html = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">{}"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"><title>Scenarios: {} passed, "
      "{} "
      "failed</title><style>{}{}</style></head><body><main>\n",
      kIndexMark, passed, failed, kPageStyle, kStyle);
  html += fmt::format("<p class=\"eyebrow\">Understudy {}</p><h1>Scenarios</h1>\n", kVersion);
  html += fmt::format(
      "<div class=\"verdict {}\"><strong>{}</strong><div><p class=\"reason\">{} passed, {} "
      "failed</p></div></div>\n",
      failed == 0 ? "go" : "no-go", failed == 0 ? "PASS" : "FAIL", passed, failed);
  html += "<section class=\"scenario-overview\">" + overview(scenarios, history) + "</section><section>\n";
  for (const bool passing : {false, true})
    for (const IndexedScenario& scenario : scenarios)
      if (scenario.result.passed() == passing) html += scenario_section(scenario, history);
  return html + "</section></main></body></html>\n";
}

}  // namespace understudy::report
