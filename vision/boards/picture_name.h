// Which camera, layer or pose a picture shows, by its file's name.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace understudy::vision {

/// A pattern such as `boards/camera{camera}-layer{layer:02}.png`: a word in braces stands for a number,
/// written with at least as many digits as `:02` says.
class PictureName {
 public:
  PictureName() = default;
  /// Each of `words` must occur once, in the part behind the last slash, with something that is no digit
  /// between any two. Throws InputError saying what is wrong, without a place.
  PictureName(const std::string& pattern, const std::vector<std::string>& words);

  const std::string& pattern() const { return pattern_; }
  /// `numbers` in the order of the constructor's words.
  std::string name(const std::vector<int>& numbers) const;
  /// The numbers of a file's name, whatever folder it is in; nothing when it does not fit. Up to six digits
  /// each.
  std::optional<std::vector<int>> numbers(const std::string& file) const;

 private:
  struct Part {
    std::string text;  // of a literal
    int word = -1;     // else: which number
    std::size_t digits = 1;
  };
  std::string pattern_;
  std::vector<Part> parts_;
  std::size_t words_ = 0;
};

}  // namespace understudy::vision
