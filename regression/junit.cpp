#include "regression/junit.h"

#include <algorithm>
#include <cstdint>

#include <fmt/format.h>

#include "core/text/xml.h"

namespace understudy::regression {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";  // U+FFFD

// Length of the UTF-8 sequence at `at`, or 0 where there is none that XML 1.0 allows (section 2.2).
std::size_t sequence_length(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[at + i]); };
  const std::uint8_t lead = byte(0);
  if (lead < 0x80) return lead >= 0x20 || lead == '\t' || lead == '\n' || lead == '\r' ? 1 : 0;
  const std::size_t length = lead >= 0xC2 && lead < 0xE0   ? 2
                             : lead >= 0xE0 && lead < 0xF0 ? 3
                             : lead >= 0xF0 && lead < 0xF5 ? 4
                                                           : 0;
  if (length == 0 || at + length > text.size()) return 0;
  std::uint32_t point = lead & (0xFFu >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0u) != 0x80u) return 0;
    point = point << 6 | (byte(i) & 0x3Fu);
  }
  const bool overlong = (length == 3 && point < 0x800) || (length == 4 && point < 0x10000);
  const bool surrogate = point >= 0xD800 && point < 0xE000;
  return overlong || surrogate || point == 0xFFFE || point == 0xFFFF || point > 0x10FFFF ? 0 : length;
}

/// For attributes and text: also line ends and tabs, which a reader would turn into spaces, and bytes that
/// are not XML's. tinyxml2 leaves both as they are.
std::string escape(std::string_view text) {
  std::string escaped;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = sequence_length(text, at);
    const char c = text[at];
    if (length == 0)
      escaped += kReplacement;
    else if (c == '&')
      escaped += "&amp;";
    else if (c == '<')
      escaped += "&lt;";
    else if (c == '>')
      escaped += "&gt;";
    else if (c == '"')
      escaped += "&quot;";
    else if (c == '\n' || c == '\t' || c == '\r')
      escaped += fmt::format("&#{};", static_cast<int>(c));
    else
      escaped += text.substr(at, length);
    at += std::max<std::size_t>(1, length);
  }
  return escaped;
}

tinyxml2::XMLElement& add_case(tinyxml2::XMLElement& suite, const ScenarioResult& result,
                               const std::string& name) {
  return add_element(
      suite, "testcase",
      {{"classname", escape(result.name)}, {"name", escape(name)}, {"file", escape(result.file)}});
}

struct Counts {
  std::size_t tests = 0, failures = 0, errors = 0;
};

Counts counts_of(const ScenarioResult& result) {
  Counts counts;
  counts.errors = result.error.empty() ? 0 : 1;
  counts.tests = result.checks.size() + counts.errors;
  for (const Check& check : result.checks) counts.failures += check.ok ? 0 : 1;
  return counts;
}

void add_suite(tinyxml2::XMLElement& suites, const ScenarioResult& result) {
  const Counts counts = counts_of(result);
  auto& suite = add_element(suites, "testsuite",
                            {{"name", escape(result.name)},
                             {"tests", std::to_string(counts.tests)},
                             {"failures", std::to_string(counts.failures)},
                             {"errors", std::to_string(counts.errors)}});
  if (result.seconds) suite.SetAttribute("time", fmt::format("{:.3f}", *result.seconds).c_str());
  if (!result.report.empty())
    add_element(add_element(suite, "properties", {}), "property",
                {{"name", "report"}, {"value", escape(result.report)}});
  if (counts.errors > 0)
    add_element(add_case(suite, result, "run"), "error", {{"message", escape(result.error)}});
  for (const Check& check : result.checks) {
    auto& element = add_case(suite, result, check.name);
    if (check.ok) continue;
    const std::string message = escape(check.message);
    add_element(element, "failure", {{"message", message}}).SetText(message.c_str());
  }
}

}  // namespace

std::string junit_xml(std::span<const ScenarioResult> results) {
  Counts all;
  for (const ScenarioResult& result : results) {
    const Counts counts = counts_of(result);
    all.tests += counts.tests;
    all.failures += counts.failures;
    all.errors += counts.errors;
  }
  tinyxml2::XMLDocument document(false);  // values come escaped
  document.InsertEndChild(document.NewDeclaration());
  auto& suites = add_element(document, "testsuites",
                             {{"tests", std::to_string(all.tests)},
                              {"failures", std::to_string(all.failures)},
                              {"errors", std::to_string(all.errors)}});
  for (const ScenarioResult& result : results) add_suite(suites, result);
  return to_text(document);
}

}  // namespace understudy::regression
