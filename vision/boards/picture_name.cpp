#include "vision/boards/picture_name.h"

#include <algorithm>
#include <cctype>

#include "core/error.h"

namespace understudy::vision {
namespace {

constexpr std::size_t kMostDigits = 6;

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// Of `layer:02`: 2; of `layer`: 1.
std::size_t digits_of(const std::string& field, std::size_t colon) {
  if (colon == std::string::npos) return 1;
  const std::string width = field.substr(colon + 1);
  if (width.size() != 2 || width[0] != '0' || width[1] < '1' ||
      width[1] > '0' + static_cast<int>(kMostDigits))
    throw InputError("{" + field + "} is not a word, or a word with :01 to :06 behind it");
  return static_cast<std::size_t>(width[1] - '0');
}

}  // namespace

PictureName::PictureName(const std::string& pattern, const std::vector<std::string>& words)
    : pattern_(pattern), words_(words.size()) {
  for (const char c : pattern)
    if (std::iscntrl(static_cast<unsigned char>(c)) != 0)
      throw InputError("a control character is no part of a file's name");
  const std::size_t slash = pattern.rfind('/');
  const std::size_t last_part = slash == std::string::npos ? 0 : slash + 1;
  std::vector<bool> seen(words.size(), false);
  for (std::size_t at = 0; at < pattern.size();) {
    const std::size_t brace = std::min(pattern.find('{', at), pattern.size());
    if (brace > at) parts_.push_back({pattern.substr(at, brace - at), -1, 1});
    if (brace == pattern.size()) break;
    const std::size_t end = pattern.find('}', brace);
    if (end == std::string::npos) throw InputError("a { has no }");
    const std::string field = pattern.substr(brace + 1, end - brace - 1);
    const std::size_t colon = field.find(':');
    const auto word = std::find(words.begin(), words.end(), field.substr(0, colon));
    if (word == words.end())
      throw InputError("{" + field + "} is not one of {" + words.front() + "}, {" + words.back() + "}");
    const auto index = static_cast<std::size_t>(word - words.begin());
    if (seen[index]) throw InputError("{" + *word + "} occurs twice");
    if (brace < last_part)
      throw InputError("{" + *word + "} is in a folder's name; it must be in the file's");
    if (!parts_.empty() && (parts_.back().word >= 0 || is_digit(parts_.back().text.back())))
      throw InputError("{" + *word +
                       "} follows another number; something that is no digit must be between them");
    if (end + 1 < pattern.size() && is_digit(pattern[end + 1]))
      throw InputError("{" + *word + "} is followed by a digit");
    seen[index] = true;
    parts_.push_back({"", static_cast<int>(index), digits_of(field, colon)});
    at = end + 1;
  }
  for (std::size_t i = 0; i < words.size(); ++i)
    if (!seen[i]) throw InputError("{" + words[i] + "} is missing");
}

std::string PictureName::name(const std::vector<int>& numbers) const {
  std::string name;
  for (const Part& part : parts_) {
    if (part.word < 0) {
      name += part.text;
      continue;
    }
    const std::string digits = std::to_string(numbers[static_cast<std::size_t>(part.word)]);
    if (digits.size() < part.digits) name += std::string(part.digits - digits.size(), '0');
    name += digits;
  }
  return name;
}

std::optional<std::vector<int>> PictureName::numbers(const std::string& file) const {
  const auto behind_slash = [](const std::string& path) {
    const std::size_t slash = path.rfind('/');
    return slash == std::string::npos ? path : path.substr(slash + 1);
  };
  const std::string name = behind_slash(file);
  std::vector<int> numbers(words_, 0);
  std::size_t at = 0;
  for (const Part& part : parts_) {
    if (part.word < 0) {
      const std::string text = behind_slash(part.text);
      if (name.compare(at, text.size(), text) != 0) return std::nullopt;
      at += text.size();
      continue;
    }
    std::size_t end = at;
    while (end < name.size() && is_digit(name[end])) ++end;
    if (end - at < part.digits || end - at > kMostDigits) return std::nullopt;
    numbers[static_cast<std::size_t>(part.word)] = std::stoi(name.substr(at, end - at));
    at = end;
  }
  return at == name.size() && words_ > 0 ? std::optional(numbers) : std::nullopt;
}

}  // namespace understudy::vision
