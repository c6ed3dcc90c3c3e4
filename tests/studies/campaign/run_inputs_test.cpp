#include "studies/campaign/run_inputs.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "core/file/output_file.h"
#include "core/file/read_file.h"
#include "machine/fixture_file.h"
#include "machine/model_files.h"
#include "tests/temporary_folder.h"

namespace understudy::studies {
namespace {

class CachedInputs : public testing::Test {
 protected:
  void SetUp() override {
    copy("machine.yaml", machine::find_model("hexapod"));
    copy("part.stl", machine::find_fixture("bottle"));
    write_file(folder_ / "line.gcode", "M104 S230\nG1 X0 Y0 Z60 F3000\nG1 X1 Y0 Z60 E0.08 F600\n");
    write_file(
        folder_ / "s.yaml",
        "name: line\ndescription: d\nsource: s\nmachine: machine.yaml\nprogram: line.gcode\n"
        "fixture: part.stl\nas_built: sampled\nseed: 1\ngap_control: off\nengine: quasistatic\nexpect:\n"
        "  - {metric: verdict, equals: go, source: a test}\n");
    campaign_.file = folder_ / "c.yaml";
    campaign_.scenarios = {(folder_ / "s.yaml").string()};
    campaign_.seed_last = 2;
  }
  void copy(const std::string& name, const std::filesystem::path& from) {
    write_file(folder_ / name, read_file(from));
  }
  CampaignTools tools() const {
    CampaignTools tools;
    tools.summary_json = [](const rehearsal::Record& record) { return record.provenance.inputs_sha256; };
    return tools;
  }

  TemporaryFolder folder_;
  Campaign campaign_;
};

TEST_F(CachedInputs, AreReadOnceForAllRuns) {
  const RunPlan plan(campaign_);
  RunInputs inputs(campaign_, tools());
  const RunRow first = inputs.rehearse(plan.run(0));
  ASSERT_EQ(first.error, "");
  for (const char* name : {"s.yaml", "machine.yaml", "part.stl"}) write_file(folder_ / name, "spoilt: [");
  EXPECT_EQ(inputs.rehearse(plan.run(1)).error, "");
  const RunRow again = inputs.rehearse(plan.run(0));
  EXPECT_EQ(again.metrics, first.metrics);
  EXPECT_EQ(again.summary_sha256, first.summary_sha256);
}

TEST_F(CachedInputs, AreReadAgainByTheNextCampaign) {
  { RunInputs(campaign_, tools()).rehearse(RunPlan(campaign_).run(0)); }
  write_file(folder_ / "machine.yaml", "spoilt: [");
  const RunRow row = RunInputs(campaign_, tools()).rehearse(RunPlan(campaign_).run(0));
  EXPECT_EQ(row.end, RunEnd::refused);
}

}  // namespace
}  // namespace understudy::studies
