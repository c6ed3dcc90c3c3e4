#include "rehearsal/findings/feature_findings.h"

#include <gtest/gtest.h>

namespace understudy::rehearsal {
namespace {

Finding error_of(const char* kind, int line) {
  return {kind, Severity::error, line, 0, 1, 0.5, "mm", "as found", 0, ""};
}

TEST(FeatureFindings, ASkirtThatDoesNotStickSpoilsNoPart) {
  const toolpath::FeatureTypes types(";TYPE:Skirt\n;\n;TYPE:WALL-OUTER\n;\n");
  std::vector<Finding> findings{error_of("adhesion", 2),  error_of("sag", 2),      error_of("gap", 2),
                                error_of("collision", 2), error_of("adhesion", 4), error_of("adhesion", 0)};
  tell_features(types, findings);
  for (const std::size_t i : {0u, 1u}) {
    EXPECT_EQ(findings[i].severity, Severity::warning);
    EXPECT_EQ(findings[i].message, "as found (Skirt, beside the part)");
  }
  EXPECT_EQ(findings[2].severity, Severity::error);
  EXPECT_EQ(findings[2].message, "as found (Skirt)");
  EXPECT_EQ(findings[3].severity, Severity::error);
  EXPECT_EQ(findings[3].message, "as found");
  EXPECT_EQ(findings[4].severity, Severity::error);
  EXPECT_EQ(findings[4].message, "as found (WALL-OUTER)");
  EXPECT_EQ(findings[5].message, "as found");
}

std::vector<Finding> sags_on_infill(int count, const char* last) {
  std::vector<Finding> findings;
  for (int i = 1; i <= count; ++i) {
    findings.push_back(error_of("sag", 1 + i));
    findings.back().about = i < count ? kShortStrand : last;
  }
  tell_features(toolpath::FeatureTypes("; FEATURE: Sparse infill\n"), findings);
  return findings;
}

TEST(FeatureFindings, FewShortStrandsOfASparseInfillAreWarnings) {
  EXPECT_EQ(sags_on_infill(1, kShortStrand)[0].severity, Severity::warning);
  EXPECT_EQ(sags_on_infill(kFewStrands, kShortStrand)[0].severity, Severity::warning);
}

TEST(FeatureFindings, ManyOrLongOnesAreErrors) {
  EXPECT_EQ(sags_on_infill(kFewStrands + 1, kShortStrand)[0].severity, Severity::error);
  EXPECT_EQ(sags_on_infill(1, "")[0].severity, Severity::error) << "a long one";
}

TEST(FeatureFindings, AShortStrandOfAWallIsAnError) {
  std::vector<Finding> findings{error_of("sag", 2)};
  findings[0].about = kShortStrand;
  tell_features(toolpath::FeatureTypes(";TYPE:Solid infill\n"), findings);
  EXPECT_EQ(findings[0].severity, Severity::error);
}

TEST(FeatureFindings, WithoutCommentsNothingChanges) {
  std::vector<Finding> findings{error_of("adhesion", 2)};
  tell_features({}, findings);
  EXPECT_EQ(findings[0].severity, Severity::error);
  EXPECT_EQ(findings[0].message, "as found");
}

}  // namespace
}  // namespace understudy::rehearsal
