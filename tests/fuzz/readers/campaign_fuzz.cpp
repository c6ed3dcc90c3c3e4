// Bytes as a campaign file; a scenario s.yaml stands beside it.
#include "studies/campaign/campaign_file.h"
#include "tests/fuzz/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understudy;
  static const fuzz::InputFile input("campaign.yaml"), scenario("s.yaml");
  static const std::string beside = scenario.fill("name: s\n").string();
  const std::string file = input.fill(fuzz::text_of(data, size)).string();
  studies::Campaign campaign;
  if (!fuzz::accepts(size, file, [&] { campaign = studies::load_campaign(file); })) return 0;
  fuzz::require(!campaign.scenarios.empty(), "a campaign without scenarios");
  fuzz::require(campaign.seed_first <= campaign.seed_last, "a range of seeds that is empty");
  fuzz::require(campaign.level > 0 && campaign.level < 1, "a level that is no probability");
  for (const auto& parameter : campaign.parameters)
    fuzz::require(!parameter.key.empty(), "a parameter without a key");
  return 0;
}
