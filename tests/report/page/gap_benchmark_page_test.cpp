#include "report/page/gap_benchmark_page.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace understudy::report {
namespace {

TEST(GapBenchmarkPage, JsonAndPageTellTheRows) {
  studies::GapBenchmark b;
  b.request.machine = "hexapod";
  b.detectors.push_back({"flat <1>", "speckle", "centroid", 100, 1, 0.5, 4.25, 9});
  b.bottle.push_back({"start", 2, 2, 1, 1, 0.75, 0.5, 0.1, 0.13, 0.2, {{"too close", 1}}, {}});
  b.bottle.back().along = {{0.11, 0.13, 0.25}, {0.12, 0.14, 0.2}};
  const auto json = nlohmann::json::parse(gap_benchmark_json(b));
  EXPECT_EQ(json.at("schema"), "understudy.gap-benchmark/1");
  EXPECT_EQ(json.at("detectors").at(0).at("sigma_um"), 4.25);
  EXPECT_EQ(json.at("bottle").at(0).at("stops").at("too close"), 1);
  EXPECT_EQ(json.at("bottle").at(0).at("along").at("p95_mm"), nlohmann::json({0.25, 0.2}));
  EXPECT_FALSE(json.contains("approaches"));  // it was not run
  const std::string page = gap_benchmark_html(b);
  EXPECT_NE(page.find("flat &lt;1&gt;"), std::string::npos);
  EXPECT_EQ(page.find("src=\"http"), std::string::npos);
  EXPECT_NE(page.find("<polygon"), std::string::npos);  // the gap along the line
  EXPECT_NE(gap_benchmark_table(b).find("4.2"), std::string::npos);
}

}  // namespace
}  // namespace understudy::report
