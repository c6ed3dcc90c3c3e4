#include "report/page/word_table.h"

#include <algorithm>

#include <fmt/format.h>

#include "report/markup.h"

namespace understudy::report {
namespace {

bool last_is_words(const WordTable& t) { return t.head.back() == "stops"; }
bool is_words(const WordTable& t, std::size_t column) {
  return column < t.words || (last_is_words(t) && column + 1 == t.head.size());
}

}  // namespace

std::string plain_text(const WordTable& t) {
  std::vector<std::size_t> width;
  for (std::size_t c = 0; c < t.head.size(); ++c) {
    width.push_back(t.head[c].size());
    for (const auto& row : t.rows) width[c] = std::max(width[c], row[c].size());
  }
  const auto line = [&](const std::vector<std::string>& cells) {
    std::string text;
    for (std::size_t c = 0; c < cells.size(); ++c)
      text += is_words(t, c) ? fmt::format("{:<{}}  ", cells[c], width[c])
                             : fmt::format("{:>{}}  ", cells[c], width[c]);
    text.erase(text.find_last_not_of(' ') + 1);
    return text + "\n";
  };
  std::string text = t.title + "\n" + line(t.head);
  for (const auto& row : t.rows) text += line(row);
  return text;
}

std::string html_section(const WordTable& t) {
  std::string html = fmt::format("<section><h2>{}</h2><p class=\"note\">{}</p><table><thead><tr>",
                                 html_text(t.title), html_text(t.note));
  for (std::size_t c = 0; c < t.head.size(); ++c)
    html += fmt::format("<th{}>{}</th>", is_words(t, c) ? "" : " class=\"number\"", html_text(t.head[c]));
  html += "</tr></thead><tbody>\n";
  for (const auto& row : t.rows) {
    html += "<tr>";
    for (std::size_t c = 0; c < row.size(); ++c)
      html += fmt::format("<td{}>{}</td>", is_words(t, c) ? "" : " class=\"number\"", html_text(row[c]));
    html += "</tr>\n";
  }
  return html + "</tbody></table></section>\n";
}

std::string digits(double value, int decimals) { return fmt::format("{:.{}f}", value, decimals); }

}  // namespace understudy::report
