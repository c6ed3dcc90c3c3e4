// Machine files with one mistake, and the one line that says so.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "machine/description.h"
#include "tests/temporary_folder.h"

namespace understudy::machine {

class EditedFile : public testing::Test {
 protected:
  std::string write(const std::string& text) const {
    const std::filesystem::path path = folder_ / "machine.yaml";
    std::ofstream(path) << text;
    return path.string();
  }

  /// `text` with its first `from` at or after the first `after` replaced: that is the edited line.
  std::string edited(std::string text, const std::string& after, const std::string& from,
                     const std::string& to) {
    const auto start = text.find(after);
    EXPECT_NE(start, std::string::npos) << after << " is not in the file";
    const auto place = text.find(from, start);
    EXPECT_NE(place, std::string::npos) << from << " is not in the file";
    line_ = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(place), '\n');
    return text.replace(place, from.size(), to);
  }

  static constexpr const char* kInThatLine = " (in the edited line)";

  /// The one line of the refusal, with kInThatLine where it names the edited line; "accepted" where there is
  /// none.
  std::string error_of(const std::string& text) const {
    try {
      load_machine(write(text));
    } catch (const InputError& error) {
      const std::string what = error.what();
      EXPECT_EQ(what.find('\n'), std::string::npos) << "more than one line";
      EXPECT_THAT(what, testing::HasSubstr("machine.yaml:"));
      const bool there = what.find("machine.yaml:" + std::to_string(line_) + ":") != std::string::npos;
      return there ? what + kInThatLine : what;
    }
    return "accepted";
  }

  const TemporaryFolder folder_;

 private:
  std::ptrdiff_t line_ = 0;
};

}  // namespace understudy::machine
