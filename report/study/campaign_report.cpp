#include "report/study/campaign_report.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/text/stable_number.h"
#include "core/version.h"
#include "report/json_text.h"
#include "report/study/error_budget_report.h"

namespace understudy::report {
namespace {

using studies::Campaign;
using studies::CampaignGroup;
using studies::CampaignResult;
using studies::Frequency;
using studies::Interval;
using studies::Sensitivity;
using Json = nlohmann::ordered_json;

Json number(double value) {
  if (!std::isfinite(value)) return nullptr;
  return stable_number(value, "campaign");
}

Json interval_value(const Interval& interval) {
  return {{"value", number(interval.value)}, {"low", number(interval.low)}, {"high", number(interval.high)}};
}

Json frequency_value(const Frequency& frequency) {
  Json value{{"count", frequency.count}, {"runs", frequency.runs}};
  value["probability"] = interval_value(frequency.probability);
  return value;
}

Json point_value(const Campaign& campaign, const studies::ParameterValues& values) {
  Json point = Json::object();
  for (std::size_t p = 0; p < values.size(); ++p) point[campaign.parameters[p].key] = values[p];
  return point;
}

Json group_value(const Campaign& campaign, const CampaignGroup& group) {
  Json value{{"scenario", group.scenario}};
  if (!group.values.empty()) value["point"] = point_value(campaign, group.values);
  value["runs"] = group.runs;
  value["no_answer"] = group.no_answer;
  value["go"] = frequency_value(group.go);
  value["go_without_warnings"] = frequency_value(group.clean);
  value["findings"] = Json::object();
  for (const auto& [kind, frequency] : group.findings) value["findings"][kind] = frequency_value(frequency);
  value["metrics"] = Json::array();
  for (const studies::MetricSpread& metric : group.metrics) {
    Json one{{"metric", metric.metric},
             {"unit", metric.unit},
             {"runs", metric.runs},
             {"quantiles", Json::array()}};
    for (std::size_t q = 0; q < metric.quantiles.size(); ++q) {
      Json quantile = interval_value(metric.quantiles[q]);
      quantile["share"] = studies::kQuantileShares[q];
      one["quantiles"].push_back(std::move(quantile));
    }
    value["metrics"].push_back(std::move(one));
  }
  return value;
}

std::string factor_name(const Campaign& campaign, std::size_t which) {
  return which < campaign.parameters.size() ? campaign.parameters[which].key : "built machine";
}

Json sensitivity_value(const Campaign& campaign, const Sensitivity& sensitivity) {
  Json value{
      {"scenario", sensitivity.scenario}, {"figure", sensitivity.figure}, {"pairs", sensitivity.pairs}};
  if (!sensitivity.why.empty()) value["not_shared_out"] = sensitivity.why;
  value["factors"] = Json::array();
  for (std::size_t g = 0; g < sensitivity.shares.size(); ++g) {
    const auto index = [](const studies::SobolIndex& i) { return interval_value({i.value, i.low, i.high}); };
    value["factors"].push_back({{"factor", factor_name(campaign, g)},
                                {"first", index(sensitivity.shares[g].first)},
                                {"total", index(sensitivity.shares[g].total)}});
  }
  return value;
}

std::string cell(double value) { return std::isfinite(value) ? fmt::format("{:.6g}", value) : ""; }

/// A word of a table of values.
std::string csv_word(const std::string& word) {
  if (word.find_first_of(",\"\n") == std::string::npos) return word;
  std::string quoted = "\"";
  for (const char c : word) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string percent(const Interval& interval) {
  return fmt::format("{:5.1f} % ({:.1f} to {:.1f})", 100 * interval.value, 100 * interval.low,
                     100 * interval.high);
}

std::string group_table(const Campaign& campaign, const CampaignGroup& group) {
  std::string text =
      fmt::format("\n{}, {}: {} runs{}\n", group.scenario, point_text(campaign, group.values), group.runs,
                  group.no_answer > 0 ? fmt::format(", {} without an answer", group.no_answer) : "");
  text += fmt::format("  GO                  {}\n  GO without warnings {}\n", percent(group.go.probability),
                      percent(group.clean.probability));
  for (const auto& [kind, frequency] : group.findings)
    if (frequency.count > 0) text += fmt::format("  finds {:<13} {}\n", kind, percent(frequency.probability));
  for (const studies::MetricSpread& metric : group.metrics) {
    text += fmt::format("  {} [{}]:", metric.metric, metric.unit);
    for (std::size_t q = 0; q < metric.quantiles.size(); ++q) {
      const Interval& interval = metric.quantiles[q];
      text += metric.runs == 0 ? " none"
                               : fmt::format("{} {} {:.4g} ({:.4g} to {:.4g})", q ? "," : "",
                                             quantile_name(q), interval.value, interval.low, interval.high);
      if (metric.runs == 0) break;
    }
    text += "\n";
  }
  return text;
}

std::string sensitivity_table(const Campaign& campaign, const Sensitivity& sensitivity) {
  std::string text = fmt::format("\n{}: what {} depends on, {} pairs\n", sensitivity.scenario,
                                 sensitivity.figure, sensitivity.pairs);
  if (!sensitivity.why.empty()) return text + fmt::format("  not shared out: {}\n", sensitivity.why);
  for (std::size_t g = 0; g < sensitivity.shares.size(); ++g) {
    const auto& [first, total] = sensitivity.shares[g];
    text += fmt::format("  {:<34} first {} [{}, {}]  total {} [{}, {}]\n", factor_name(campaign, g),
                        share_text(first.value), share_text(first.low), share_text(first.high),
                        share_text(total.value), share_text(total.low), share_text(total.high));
  }
  return text;
}

}  // namespace

std::string quantile_name(std::size_t which) {
  const double share = studies::kQuantileShares[which];
  return share == 0.5 ? "median" : fmt::format("{:g} %", 100 * share);
}

std::string point_text(const Campaign& campaign, const studies::ParameterValues& values) {
  std::string text;
  for (std::size_t p = 0; p < values.size(); ++p)
    text += fmt::format("{}{} {}", p ? ", " : "", campaign.parameters[p].key, values[p]);
  return text.empty() ? "all" : text;
}

std::vector<std::string> kinds_found(const CampaignResult& result) {
  std::set<std::string> kinds;
  for (const CampaignGroup& group : result.groups)
    for (const auto& [kind, frequency] : group.findings)
      if (frequency.count > 0) kinds.insert(kind);
  return {kinds.begin(), kinds.end()};
}

std::string campaign_csv(const Campaign& campaign, const CampaignResult& result) {
  std::string csv = "scenario";
  const bool grid = campaign.plan == studies::SamplingPlan::grid;
  if (grid)
    for (const auto& parameter : campaign.parameters) csv += "," + csv_word(parameter.key);
  csv += ",figure,unit,runs,count,value,low,high\n";
  for (const CampaignGroup& group : result.groups) {
    std::string head = csv_word(group.scenario);
    for (const std::string& value : group.values) head += "," + csv_word(value);
    const auto line = [&](const std::string& figure, const Frequency& frequency) {
      const Interval& p = frequency.probability;
      csv += fmt::format("{},{},1,{},{},{},{},{}\n", head, figure, frequency.runs, frequency.count,
                         cell(p.value), cell(p.low), cell(p.high));
    };
    csv += fmt::format("{},no_answer,1,{},{},,,\n", head, group.runs, group.no_answer);
    line("go", group.go);
    line("go_without_warnings", group.clean);
    for (const auto& [kind, frequency] : group.findings) line("finding." + kind, frequency);
    for (const studies::MetricSpread& metric : group.metrics)
      for (std::size_t q = 0; q < metric.quantiles.size(); ++q) {
        const Interval& i = metric.quantiles[q];
        csv += fmt::format("{},{}.q{:02.0f},{},{},,{},{},{}\n", head, metric.metric,
                           100 * studies::kQuantileShares[q], metric.unit, metric.runs, cell(i.value),
                           cell(i.low), cell(i.high));
      }
  }
  for (const Sensitivity& sensitivity : result.sensitivities)
    for (std::size_t g = 0; g < sensitivity.shares.size(); ++g)
      for (const auto& [name, index] :
           {std::pair{"first", sensitivity.shares[g].first}, std::pair{"total", sensitivity.shares[g].total}})
        csv += fmt::format("{},{}.{}.{},1,{},,{},{},{}\n", csv_word(sensitivity.scenario), sensitivity.figure,
                           name, csv_word(factor_name(campaign, g)), sensitivity.pairs, cell(index.value),
                           cell(index.low), cell(index.high));
  return csv;
}

std::string campaign_json(const Campaign& campaign, const CampaignResult& result,
                          const std::string& inputs_sha256) {
  Json json;
  json["schema"] = "understudy.campaign/1";
  json["name"] = campaign.name;
  if (!campaign.description.empty()) json["description"] = campaign.description;
  json["plan"] = to_string(campaign.plan);
  json["seeds"] = {campaign.seed_first, campaign.seed_last};
  json["parameters"] = Json::array();
  for (const auto& parameter : campaign.parameters) json["parameters"].push_back(parameter.key);
  json["runs"] = result.runs;
  json["planned_runs"] = result.planned_runs;
  json["stopped_early"] = result.stopped_early;
  json["interval"] = {
      {"level", number(campaign.level)}, {"level_of_go", number(result.go_level)}, {"looks", result.looks}};
  json["groups"] = Json::array();
  for (const CampaignGroup& group : result.groups) json["groups"].push_back(group_value(campaign, group));
  if (!result.sensitivities.empty()) json["sensitivities"] = Json::array();
  for (const Sensitivity& one : result.sensitivities)
    json["sensitivities"].push_back(sensitivity_value(campaign, one));
  json["provenance"] = {{"version", kVersion}, {"inputs_sha256", inputs_sha256}};
  return to_text(json, 2) + "\n";
}

std::string campaign_table(const Campaign& campaign, const CampaignResult& result) {
  std::string text = fmt::format("{}: {} runs", campaign.name, result.runs);
  if (result.stopped_early)
    text += fmt::format(" of {}: every interval of P(GO) is within +-{:g}", result.planned_runs,
                        campaign.stop->half_width);
  text += fmt::format("\nintervals of {:g} %\n", 100 * campaign.level);
  for (const CampaignGroup& group : result.groups) text += group_table(campaign, group);
  for (const Sensitivity& one : result.sensitivities) text += sensitivity_table(campaign, one);
  return text;
}

}  // namespace understudy::report
