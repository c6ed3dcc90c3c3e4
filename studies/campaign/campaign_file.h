// Campaign files.
#pragma once

#include <filesystem>

#include "core/yaml/map_schema.h"
#include "studies/campaign/campaign.h"

namespace understudy::studies {

/// Paths in the file are relative to it; here they are not any more. Throws InputError with file, line, key,
/// value and limit: for what YamlMap refuses, empty ranges, a parameter that is told twice, values that do
/// not go with the plan, metrics that are not known, and more runs than a campaign may have.
Campaign load_campaign(const std::filesystem::path& path);

/// The keys of such a file, as load_campaign() asks for them.
MapSchema campaign_schema();

}  // namespace understudy::studies
