// What a campaign found, as table.csv, campaign.json and lines for a terminal.
#pragma once

#include <string>
#include <vector>

#include "studies/campaign/campaign.h"
#include "studies/campaign/campaign_result.h"

namespace understudy::report {

/// "machine.gap.aim_mm 0.13, scenario.turn_deg 5", or "all" without parameters.
std::string point_text(const studies::Campaign& campaign, const studies::ParameterValues& values);

/// A line for each group and each thing asked of it.
std::string campaign_csv(const studies::Campaign& campaign, const studies::CampaignResult& result);
std::string campaign_json(const studies::Campaign& campaign, const studies::CampaignResult& result,
                          const std::string& inputs_sha256);
std::string campaign_table(const studies::Campaign& campaign, const studies::CampaignResult& result);

/// Kinds of finding that any run of any group has, sorted.
std::vector<std::string> kinds_found(const studies::CampaignResult& result);

/// "5 %" or "median", of an index of studies::kQuantileShares.
std::string quantile_name(std::size_t which);

}  // namespace understudy::report
