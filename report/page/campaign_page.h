// The page of a campaign: one table of probabilities, one of figures, one of sensitivities.
#pragma once

#include <string>

#include "studies/campaign/campaign.h"
#include "studies/campaign/campaign_result.h"

namespace understudy::report {

std::string campaign_html(const studies::Campaign& campaign, const studies::CampaignResult& result);

}  // namespace understudy::report
