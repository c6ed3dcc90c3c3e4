// For libFuzzer: changes of a text that leave its form alone (a number for another, a line twice, away or
// elsewhere, a word for another of the same text), so that readers are met behind their first check.
#include <cctype>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <vector>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

struct Part {
  std::size_t begin, length;
};

bool is_number(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) || std::strchr("+-.", c) != nullptr;
}
bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }
bool is_line(char c) { return c != '\n'; }

std::vector<Part> parts_of(const std::string& text, bool (*belongs)(char)) {
  std::vector<Part> parts;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] == '\0' || !belongs(text[at])) continue;
    std::size_t end = at;
    while (end < text.size() && text[end] != '\0' && belongs(text[end])) ++end;
    parts.push_back({at, end - at});
    at = end;
  }
  return parts;
}

class TextMutator {
 public:
  TextMutator(std::string text, unsigned seed) : text_(std::move(text)), random_(seed) {}

  std::string run() {
    for (std::size_t i = 0, n = 1 + pick(3); i < n; ++i) change();
    return std::move(text_);
  }

 private:
  std::size_t pick(std::size_t n) { return random_() % n; }

  void change() {
    switch (pick(6)) {
      case 0:
      case 1:
      case 2:
        return change_number();
      case 3:
        return change_word();
      default:
        return change_line();
    }
  }

  void change_number() {
    static constexpr const char* kNumbers[] = {"0",          "-0",
                                               "1",          "-1",
                                               "2",          "6",
                                               "0.5",        "-0.5",
                                               "90",         "180",
                                               "-180",       "360",
                                               "1e-9",       "1e-7",
                                               "1e9",        "1e300",
                                               "-1e300",     "1e-300",
                                               "1e999",      "nan",
                                               ".nan",       "inf",
                                               "-.inf",      "5000",
                                               "1e5",        "100",
                                               "1000000",    "2147483647",
                                               "2147483648", "-2147483649",
                                               "4294967296", "18446744073709551616",
                                               "0.001",      "0.7071067811865476",
                                               "0x10",       "1_000",
                                               "00",         "1.",
                                               ".5",         "~"};
    const std::vector<Part> numbers = parts_of(text_, is_number);
    if (numbers.empty()) return;
    const Part part = numbers[pick(numbers.size())];
    std::string value = text_.substr(part.begin, part.length);
    if (pick(2)) {
      value = kNumbers[pick(std::size(kNumbers))];
    } else if (pick(2)) {
      const Part other = numbers[pick(numbers.size())];
      value = text_.substr(other.begin, other.length);
    } else {
      // A little more, less, or the other sign.
      const std::size_t digit = pick(value.size());
      if (std::isdigit(static_cast<unsigned char>(value[digit])))
        value[digit] = static_cast<char>('0' + pick(10));
      if (pick(4) == 0) value = value[0] == '-' ? value.substr(1) : "-" + value;
    }
    text_.replace(part.begin, part.length, value);
  }

  void change_word() {
    const std::vector<Part> words = parts_of(text_, is_word);
    if (words.empty()) return;
    const Part part = words[pick(words.size())], other = words[pick(words.size())];
    text_.replace(part.begin, part.length, text_.substr(other.begin, other.length));
  }

  void change_line() {
    const std::vector<Part> lines = parts_of(text_, is_line);
    if (lines.empty()) return;
    const Part from = lines[pick(lines.size())];
    const std::string line = text_.substr(from.begin, from.length) + "\n";
    const Part to = lines[pick(lines.size())];
    switch (pick(3)) {
      case 0:
        text_.erase(from.begin, from.length + 1);
        return;
      case 1:
        text_.insert(to.begin, line);
        return;
      default:
        text_.replace(to.begin, to.length, line.substr(0, line.size() - 1));
    }
  }

  std::string text_;
  std::minstd_rand random_;
};

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed) {
  if (seed % 3 == 0 || size == 0) return LLVMFuzzerMutate(data, size, max_size);
  const std::string text =
      TextMutator(std::string(reinterpret_cast<const char*>(data), size), seed / 3).run();
  if (text.empty() || text.size() > max_size) return LLVMFuzzerMutate(data, size, max_size);
  std::memcpy(data, text.data(), text.size());
  return text.size();
}
