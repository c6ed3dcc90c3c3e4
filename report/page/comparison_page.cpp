#include "report/page/comparison_page.h"

#include <fmt/format.h>

#include "core/version.h"
#include "report/chart/comparison_charts.h"
#include "report/markup.h"
#include "report/page/comparison_tables.h"
#include "report/page/page_parts.h"

namespace understudy::report {
namespace {

constexpr const char* kStyle = R"(
.verdict.same { color: var(--soft); }
.tables section { overflow-x: auto; }
.tables td { overflow-wrap: break-word; }
.plot-grid { grid-template-columns: repeat(auto-fit, minmax(min(440px, 100%), 1fr)); }
.legend svg { vertical-align: middle; margin-right: 7px; }
.plot-grid svg { width: 100%; height: auto; }
)";

std::string figure(const RecordedRehearsal& a, const RecordedRehearsal& b, ComparedCurve curve,
                   CurveAlong along) {
  const std::string chart = comparison_chart(a.trace, b.trace, curve, along);
  if (chart.empty()) return "";
  return fmt::format("<figure><figcaption><b>{} along {}</b></figcaption>{}</figure>\n",
                     curve == ComparedCurve::gap ? "Gap" : "Tip error",
                     along == CurveAlong::time ? "time" : "the path", chart);
}

std::string legend(const RecordedRehearsal& result, bool of_a) {
  return fmt::format("<span>{}{}: {}</span>", comparison_key(of_a), of_a ? "A" : "B",
                     html_text(result.folder.filename().string()));
}

std::string curves_section(const RehearsalComparison& comparison, const RecordedRehearsal& a,
                           const RecordedRehearsal& b) {
  std::string figures;
  for (const CurveAlong along : {CurveAlong::time, CurveAlong::path})
    for (const ComparedCurve curve : {ComparedCurve::gap, ComparedCurve::tip_error})
      figures += figure(a, b, curve, along);
  const std::string where = comparison.curves.empty() ? "They are the same, byte for byte."
                                                      : "trace.csv: " + comparison.curves + ".";
  if (figures.empty()) return "";
  return fmt::format(
      "<section class=\"plots\"><h2>Curves</h2><p class=\"note\">While filament is extruded; a value that "
      "few reach "
      "stands at the edge of the scale. {}</p><p class=\"legend\">{}{}</p><div "
      "class=\"plot-grid\">\n{}</div></section>\n",
      html_text(where), legend(a, true), legend(b, false), figures);
}

std::string command_row(const char* name, const RecordedRehearsal& result) {
  return fmt::format("<tr><th>{}</th><td><code>{}</code><br><code>{}</code></td></tr>\n", name,
                     html_text(result.folder.string()), html_text(result.run.command));
}

std::string worst_list(const RehearsalComparison& comparison) {
  std::string rows;
  for (const ComparedFindings& each : comparison.findings)
    for (const bool of_a : {true, false})
      if (const KindOfFinding& kind = of_a ? each.a : each.b; !kind.worst.empty())
        rows += fmt::format("<tr><td>{}</td><td>{}</td><td class=\"message\">{}</td></tr>\n",
                            html_text(each.kind), of_a ? "A" : "B", html_text(kind.worst));
  if (rows.empty()) return "";
  return "<details><summary>The worst finding of each kind</summary><table><tbody>" + rows +
         "</tbody></table></details>\n";
}

}  // namespace

std::string comparison_html(const RehearsalComparison& comparison, const RecordedRehearsal& a,
                            const RecordedRehearsal& b) {
  std::string html = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
      "'unsafe-inline'\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{}: two rehearsals</title>\n<style>\n",
      html_text(verdict_change(a, b, " \u2192 ")));
  html += kPageStyle;
  html += kStyle;
  html += fmt::format(
      "</style></head><body><main id=\"page\" data-ready><p class=\"eyebrow\">Understudy {}</p><h1>Two "
      "rehearsals: A {}, "
      "B {}</h1>\n"
      "<div class=\"verdict {}\"><strong>{}</strong><div><p class=\"reason\">{}.</p></div></div>\n"
      "<div class=\"tables\">\n",
      html_text(kVersion), html_text(a.folder.filename().string()), html_text(b.folder.filename().string()),
      rehearsal::word(b.grade), html_text(verdict_change(a, b, " \u2192 ")),
      html_text(comparison_sentence(comparison)));
  for (const WordTable& table : comparison_tables(comparison)) html += html_section(table);
  html += worst_list(comparison) + "</div>\n" + curves_section(comparison, a, b);
  return html + "<section class=\"provenance\"><h2>How each was made</h2><table><tbody>" +
         command_row("A", a) + command_row("B", b) + "</tbody></table></section></main></body></html>\n";
}

}  // namespace understudy::report
