#include "report/page/campaign_page.h"

#include <fmt/format.h>

#include "core/version.h"
#include "report/markup.h"
#include "report/page/page_parts.h"
#include "report/study/campaign_report.h"
#include "report/study/error_budget_report.h"

namespace understudy::report {
namespace {

using studies::Campaign;
using studies::CampaignGroup;
using studies::CampaignResult;
using studies::Frequency;
using studies::Interval;

std::string number_cell(const std::string& text) { return fmt::format("<td class=\"number\">{}</td>", text); }
std::string number_head(const std::string& text) {
  return fmt::format("<th class=\"number\">{}</th>", html_text(text));
}

std::string probability(const Frequency& frequency) {
  const Interval& p = frequency.probability;
  if (frequency.runs == 0) return number_cell("-");
  return number_cell(
      fmt::format("{:.1f} %<br><small>{:.1f} to {:.1f}</small>", 100 * p.value, 100 * p.low, 100 * p.high));
}

std::string head_cells(const CampaignGroup& group) {
  std::string html = fmt::format("<tr><td>{}</td>", html_text(group.scenario));
  for (const std::string& value : group.values) html += number_cell(html_text(value));
  return html;
}

std::string head_titles(const Campaign& campaign) {
  std::string html = "<table><thead><tr><th>scenario</th>";
  if (campaign.plan == studies::SamplingPlan::grid)
    for (const auto& parameter : campaign.parameters) html += number_head(parameter.key);
  return html;
}

std::string probabilities(const Campaign& campaign, const CampaignResult& result) {
  const std::vector<std::string> kinds = kinds_found(result);
  std::string html = "<section><h2>How probable</h2>" + head_titles(campaign) + number_head("runs") +
                     number_head("no answer") + number_head("GO") + number_head("GO without warnings");
  for (const std::string& kind : kinds) html += number_head(kind);
  html += "</tr></thead><tbody>\n";
  for (const CampaignGroup& group : result.groups) {
    html += head_cells(group) + number_cell(std::to_string(group.runs)) +
            number_cell(std::to_string(group.no_answer)) + probability(group.go) + probability(group.clean);
    for (const std::string& kind : kinds) {
      const auto found = group.findings.find(kind);
      html += probability(found == group.findings.end() ? Frequency{} : found->second);
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></section>\n";
}

std::string spreads(const Campaign& campaign, const CampaignResult& result) {
  if (campaign.metrics.empty()) return "";
  std::string html =
      "<section><h2>Figures</h2>" + head_titles(campaign) + "<th>figure</th>" + number_head("runs");
  for (std::size_t q = 0; q < std::size(studies::kQuantileShares); ++q) html += number_head(quantile_name(q));
  html += "</tr></thead><tbody>\n";
  for (const CampaignGroup& group : result.groups)
    for (const studies::MetricSpread& metric : group.metrics) {
      html += head_cells(group) +
              fmt::format("<td>{}{}</td>", html_text(metric.metric),
                          metric.unit == "1" ? "" : " [" + html_text(metric.unit) + "]") +
              number_cell(std::to_string(metric.runs));
      for (const Interval& i : metric.quantiles)
        html += number_cell(metric.runs == 0 ? "-"
                                             : fmt::format("{:.4g}<br><small>{:.4g} to {:.4g}</small>",
                                                           i.value, i.low, i.high));
      html += "</tr>\n";
    }
  return html + "</tbody></table></section>\n";
}

std::string sensitivities(const Campaign& campaign, const CampaignResult& result) {
  std::string html;
  for (const studies::Sensitivity& one : result.sensitivities) {
    html += fmt::format("<section><h2>What {} depends on: {}</h2>", html_text(one.figure),
                        html_text(one.scenario));
    if (one.shares.empty()) {
      html += fmt::format("<p class=\"note\">Not shared out: {}.</p></section>\n", html_text(one.why));
      continue;
    }
    html += "<table><thead><tr><th>factor</th>" + number_head("first") + number_head("total") +
            "</tr></thead><tbody>\n";
    for (std::size_t g = 0; g < one.shares.size(); ++g) {
      const auto index = [](const studies::SobolIndex& i) {
        return number_cell(fmt::format("{}<br><small>{} to {}</small>", share_text(i.value),
                                       share_text(i.low), share_text(i.high)));
      };
      html += fmt::format(
          "<tr><td>{}</td>{}{}</tr>\n",
          html_text(g < campaign.parameters.size() ? campaign.parameters[g].key : "built machine"),
          index(one.shares[g].first), index(one.shares[g].total));
    }
    html += "</tbody></table></section>\n";
  }
  return html;
}

}  // namespace

std::string campaign_html(const Campaign& campaign, const CampaignResult& result) {
  std::string html = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<title>{}</title>\n<style>\n",
      html_text(campaign.name));
  html += kPageStyle;
  html += fmt::format(
      "</style></head><body><main><p class=\"eyebrow\">Understudy {}</p><h1>Campaign: {}</h1>\n<p "
      "class=\"note\">{}</p>\n<p class=\"note\">{} of {} runs, plan {}, seeds {} to {}{}. Probabilities with "
      "exact "
      "intervals of {:g} % (GO: {:g} %, {} look{}), quantiles with intervals of {:g} % by bootstrap.</p>\n",
      html_text(kVersion), html_text(campaign.name), html_text(campaign.description), result.runs,
      result.planned_runs, to_string(campaign.plan), campaign.seed_first, campaign.seed_last,
      result.stopped_early ? ", stopped early: the intervals are as narrow as asked" : "",
      100 * campaign.level, 100 * result.go_level, result.looks, result.looks == 1 ? "" : "s",
      100 * campaign.level);
  html += probabilities(campaign, result) + spreads(campaign, result) + sensitivities(campaign, result);
  return html + "</main></body></html>\n";
}

}  // namespace understudy::report
