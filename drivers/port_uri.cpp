#include "drivers/port_uri.h"

#include <algorithm>
#include <cctype>
#include <charconv>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"

namespace understudy::drivers {

std::string PortUri::option(const std::string& key, const std::string& otherwise) const {
  const auto found = options.find(key);
  return found == options.end() ? otherwise : found->second;
}

void PortUri::check_options(const std::vector<std::string>& known) const {
  for (const auto& [key, value] : options) {
    if (std::ranges::find(known, key) != known.end()) continue;
    const std::string nearest = nearest_word(key, known);
    if (known.empty()) throw InputError(fmt::format("{}: {}:// has no options", text, scheme));
    throw InputError(fmt::format("{}: unknown option '{}'{}", text, key,
                                 nearest.empty() ? fmt::format(": one of {}", fmt::join(known, ", "))
                                                 : "; did you mean '" + nearest + "'?"));
  }
}

double PortUri::number(const std::string& key, double otherwise, double low, double high) const {
  const auto found = options.find(key);
  if (found == options.end()) return otherwise;
  const std::string& word = found->second;
  double value = 0;
  const auto read = std::from_chars(word.data(), word.data() + word.size(), value);
  if (read.ec != std::errc() || read.ptr != word.data() + word.size() || !(value >= low && value <= high))
    throw InputError(fmt::format("{}: {} '{}' is no number from {} to {}", text, key, word, low, high));
  return value;
}

PortUri parse_port_uri(const std::string& text) {
  PortUri uri;
  uri.text = text;
  const auto colon = text.find("://");
  if (colon == std::string::npos || colon == 0)
    throw InputError(fmt::format("port '{}': write SCHEME://PLACE, such as serial:///dev/ttyACM0", text));
  uri.scheme = text.substr(0, colon);
  std::ranges::transform(uri.scheme, uri.scheme.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  std::string rest = text.substr(colon + 3);
  const auto question = rest.find('?');
  uri.place = rest.substr(0, question);
  if (question == std::string::npos) return uri;
  rest = rest.substr(question + 1);
  for (std::size_t begin = 0; begin <= rest.size();) {
    const std::size_t end = std::min(rest.find('&', begin), rest.size());
    const std::string pair = rest.substr(begin, end - begin);
    const auto equals = pair.find('=');
    if (equals == std::string::npos || equals == 0)
      throw InputError(fmt::format("port '{}': '{}' is no KEY=VALUE", text, pair));
    if (!uri.options.emplace(pair.substr(0, equals), pair.substr(equals + 1)).second)
      throw InputError(fmt::format("port '{}': {} stands twice", text, pair.substr(0, equals)));
    begin = end + 1;
  }
  return uri;
}

}  // namespace understudy::drivers
