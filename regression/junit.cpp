#include "regression/junit.h"

#include <algorithm>
#include <cstdint>

#include <fmt/format.h>

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

std::string time_attribute(const std::optional<double>& seconds) {
  return seconds ? fmt::format(" time=\"{:.3f}\"", *seconds) : "";
}

std::string suite(const ScenarioResult& result) {
  const auto failures =
      std::count_if(result.checks.begin(), result.checks.end(), [](const Check& c) { return !c.ok; });
  const int errors = result.error.empty() ? 0 : 1;
  std::string xml = fmt::format("  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"{}\"{}>\n",
                                escape(result.name), result.checks.size() + static_cast<std::size_t>(errors),
                                failures, errors, time_attribute(result.seconds));
  const auto open_case = [&](const std::string& name) {
    xml += fmt::format("    <testcase classname=\"{}\" name=\"{}\" file=\"{}\"", escape(result.name),
                       escape(name), escape(result.file));
  };
  if (errors > 0) {
    open_case("run");
    xml += fmt::format(">\n      <error message=\"{}\"/>\n    </testcase>\n", escape(result.error));
  }
  for (const Check& check : result.checks) {
    open_case(check.name);
    if (check.ok)
      xml += "/>\n";
    else
      xml += fmt::format(">\n      <failure message=\"{0}\">{0}</failure>\n    </testcase>\n",
                         escape(check.message));
  }
  return xml + "  </testsuite>\n";
}

}  // namespace

std::string junit_xml(std::span<const ScenarioResult> results) {
  std::string suites;
  std::size_t tests = 0, failures = 0, errors = 0;
  for (const ScenarioResult& result : results) {
    suites += suite(result);
    const std::size_t error = result.error.empty() ? 0 : 1;
    tests += result.checks.size() + error;
    errors += error;
    for (const Check& check : result.checks) failures += check.ok ? 0 : 1;
  }
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites tests=\"{}\" failures=\"{}\" "
      "errors=\"{}\">\n{}"
      "</testsuites>\n",
      tests, failures, errors, suites);
}

}  // namespace understudy::regression
