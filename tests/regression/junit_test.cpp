#include "regression/junit.h"

#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/file/output_file.h"
#include "tests/temporary_folder.h"

namespace understudy::regression {
namespace {

using testing::HasSubstr;
using testing::Not;

Check check_of(const std::string& name, bool ok, const std::string& message) {
  Check check;
  check.name = name;
  check.ok = ok;
  check.message = message;
  return check;
}

ScenarioResult mixed() {
  return {"song-bottle",
          "scenarios/song-bottle.yaml",
          {check_of("verdict = go", true, ""),
           check_of("gap.start_mm <= 0.2 mm", false, "0.4 mm is above 0.2 mm")},
          "",
          std::nullopt};
}

TEST(JunitXml, CountsTestsFailuresAndErrors) {
  const ScenarioResult results[] = {mixed(), {"broken", "b.yaml", {}, "the engine failed", std::nullopt}};
  const std::string xml = junit_xml(results);
  EXPECT_THAT(xml, HasSubstr("<testsuites tests=\"3\" failures=\"1\" errors=\"1\">"));
  EXPECT_THAT(xml, HasSubstr("<testsuite name=\"song-bottle\" tests=\"2\" failures=\"1\" errors=\"0\">"));
  EXPECT_THAT(xml, HasSubstr("<testsuite name=\"broken\" tests=\"1\" failures=\"0\" errors=\"1\">"));
  EXPECT_THAT(xml, HasSubstr("name=\"gap.start_mm &lt;= 0.2 mm\""));
  EXPECT_THAT(xml, HasSubstr("<failure message=\"0.4 mm is above 0.2 mm\">"));
  EXPECT_THAT(xml, HasSubstr("<error message=\"the engine failed\"/>"));
}

TEST(JunitXml, HasNoTimeUnlessGiven) {
  ScenarioResult result = mixed();
  EXPECT_THAT(junit_xml({&result, 1}), Not(HasSubstr("time=")));
  result.seconds = 1.5;
  EXPECT_THAT(junit_xml({&result, 1}), HasSubstr("time=\"1.500\""));
}

TEST(JunitXml, EscapesWhatXmlCannotHold) {
  ScenarioResult result = mixed();
  result.checks[1].message =
      "a<b & \"c\"\n\x01 ]]> caf\xC3\xA9 \xE9 \xED\xA0\x80 \xC0\xAF \xF0\x9F\x99\x82 \xEF\xBF\xBF";
  const std::string xml = junit_xml({&result, 1});
  EXPECT_THAT(
      xml,
      HasSubstr("message=\"a&lt;b &amp; &quot;c&quot;&#10;\xEF\xBF\xBD ]]&gt; caf\xC3\xA9 \xEF\xBF\xBD "));
  EXPECT_THAT(xml, HasSubstr(" \xF0\x9F\x99\x82 "));
  EXPECT_THAT(xml, Not(HasSubstr("\xED\xA0\x80")));  // a lone surrogate
  EXPECT_THAT(xml, Not(HasSubstr("\xC0\xAF")));      // an overlong slash
}

TEST(JunitXml, IsWellFormedForAnIndependentParser) {
  if (std::system("command -v xmllint > /dev/null 2>&1") != 0) GTEST_SKIP() << "xmllint is not installed";
  std::string every_byte;
  for (int c = 1; c < 256; ++c) every_byte += static_cast<char>(c);
  ScenarioResult results[] = {
      mixed(), {every_byte, every_byte, {check_of(every_byte, false, every_byte)}, every_byte, 2.0}};
  const TemporaryFolder folder;
  const auto path = folder / "junit.xml";
  write_file(path, junit_xml(results));
  EXPECT_EQ(std::system(("xmllint --noout '" + path.string() + "'").c_str()), 0);
}

TEST(ScenarioResult, PassesOnlyWhenSomethingWasCheckedAndAllHeld) {
  ScenarioResult result = mixed();
  EXPECT_FALSE(result.passed());
  result.checks[1].ok = true;
  EXPECT_TRUE(result.passed());
  result.error = "engine";
  EXPECT_FALSE(result.passed());
  EXPECT_FALSE((ScenarioResult{"x", "x.yaml", {}, "", std::nullopt}).passed());
}

}  // namespace
}  // namespace understudy::regression
