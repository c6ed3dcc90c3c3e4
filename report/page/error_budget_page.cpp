#include "report/page/error_budget_page.h"

#include <fmt/format.h>

#include "core/version.h"
#include "report/chart/error_budget_charts.h"
#include "report/markup.h"
#include "report/page/page_parts.h"
#include "report/study/error_budget_report.h"

namespace understudy::report {
namespace {

using studies::ErrorBudget;
using studies::QuantityBudget;
using studies::SobolIndex;

std::string cell(const SobolIndex& index) {
  return fmt::format("<td class=\"number\">{}</td><td class=\"number\">{} to {}</td>",
                     share_text(index.value), share_text(index.low), share_text(index.high));
}

std::string table(const QuantityBudget& quantity, const ErrorBudget& budget) {
  std::string html =
      "<table><thead><tr><th>group</th><th class=\"number\">first</th><th class=\"number\">95 %</th>"
      "<th class=\"number\">total</th><th class=\"number\">95 %</th><th>what changes it</th>"
      "<th>key of the machine file</th></tr></thead><tbody>\n";
  for (const std::size_t g : by_total(quantity)) {
    const auto group = budget.plan.groups[g];
    const Remedy remedy = remedy_of(group, budget.plan.as_built);
    html += fmt::format("<tr><td>{}</td>{}{}<td>{}</td><td><code>{}</code></td></tr>\n",
                        html_text(to_string(group)), cell(quantity.shares[g].first),
                        cell(quantity.shares[g].total), html_text(remedy.procedure), html_text(remedy.key));
  }
  return html + "</tbody></table>";
}

std::string section(const QuantityBudget& quantity, const ErrorBudget& budget) {
  const auto words = studies::words(quantity.quantity);
  std::string html = fmt::format("<section><h2>{}</h2>", html_text(words.what));
  if (quantity.shares.empty())
    return html +
           fmt::format("<p class=\"note\">Not shared out: {}.</p></section>\n", html_text(quantity.why));
  const std::string unit = std::string(words.unit) == "1" ? "" : fmt::format(" {}", words.unit);
  html += fmt::format("<p class=\"note\">Mean {:.4g}{}, 1 sigma {:.4g}{}, from {} of {} samples.</p>",
                      quantity.mean, unit, quantity.sigma, unit, quantity.samples, budget.samples);
  return html + error_budget_chart(quantity, budget.plan) + table(quantity, budget) + "</section>\n";
}

}  // namespace

std::string error_budget_html(const ErrorBudget& budget) {
  std::string html =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<title>Error budget</title>\n<style>\n";
  html += kPageStyle;
  html += fmt::format(
      "</style></head><body><main><p class=\"eyebrow\">Understudy {}</p><h1>Error budget: {}</h1>\n"
      "<p class=\"note\">{}, gap control {}. {} of them stopped early. <code>{}</code></p>\n"
      "<p class=\"note\">First: the share of the variance that goes when this group alone is known. Total: "
      "the share that stays when all others are known. Bars show 95 % intervals of a bootstrap.</p>\n",
      html_text(kVersion), html_text(budget.machine), html_text(budget_cost(budget.plan, budget.samples)),
      html_text(budget.gap_control), budget.stopped, html_text(budget.command));
  for (const QuantityBudget& quantity : budget.quantities) html += section(quantity, budget);
  return html + "</main></body></html>\n";
}

}  // namespace understudy::report
