#include "report/page/report_html.h"

#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "rehearsal/findings/verdict.h"
#include "report/json_text.h"
#include "report/markup.h"
#include "report/page/page_parts.h"

namespace understudy::report {
namespace {

// Inside <script> only "</" and "<!--" can end or bend the block, and in JSON '<' stands in strings only.
std::string escape_json_for_script(const std::string& json) {
  std::string escaped;
  escaped.reserve(json.size());
  for (const char c : json) {
    if (c == '<')
      escaped += "\\u003c";
    else
      escaped += c;
  }
  return escaped;
}

// One pass, so that a marker inside an inserted part stays as it is.
std::string fill(std::string_view page, const std::vector<std::pair<std::string_view, std::string>>& parts) {
  std::string filled;
  for (std::size_t at = 0; at < page.size();) {
    const std::size_t open = page.find("{{", at);
    filled += page.substr(at, open - at);
    if (open == std::string_view::npos) break;
    const std::size_t close = page.find("}}", open);
    const std::string_view marker = page.substr(open + 2, close - open - 2);
    const auto part =
        std::find_if(parts.begin(), parts.end(), [&](const auto& p) { return p.first == marker; });
    if (part == parts.end()) throw std::logic_error("the page has an unknown marker " + std::string(marker));
    filled += part->second;
    at = close + 2;
  }
  return filled;
}

struct Words {
  std::string title, verdict, reason;
  std::string connect;  ///< of the Content-Security-Policy
};

std::string page_of(const Words& words, const std::string& json) {
  return fill(kPageTemplate, {{"connect", words.connect},
                              {"title", html_text(words.title)},
                              {"verdict", words.verdict},
                              {"reason", html_text(words.reason)},
                              {"notices", std::string(kPageNotices)},
                              {"plots-style", std::string(kPlotsStyle)},
                              {"style", std::string(kPageStyle)},
                              {"record", escape_json_for_script(json)},
                              {"script", std::string(kPageScript)}});
}

}  // namespace

std::string report_html(const rehearsal::Record& record, const nlohmann::ordered_json& data) {
  const std::string verdict = rehearsal::headline(rehearsal::grade_of(record));
  return page_of({verdict + ": " + record.title, verdict, rehearsal::verdict_sentence(record), ""},
                 to_text(data, -1));
}

std::string live_html(const std::string& title, const std::string& json) {
  return page_of({"running: " + title, "running", "The rehearsal still runs.", "; connect-src 'self'"}, json);
}

}  // namespace understudy::report
