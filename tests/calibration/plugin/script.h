// A shell script in a file of its own, for as long as it is in scope.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace understudy::calibration {

class Script {
 public:
  explicit Script(const std::string& text) {
    static int count = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("understudy-plugin-" + std::to_string(::getpid()) + "-" + std::to_string(count++) + ".sh");
    std::ofstream(path_) << text;
  }
  ~Script() { std::filesystem::remove(path_); }
  std::string command() const { return "sh " + path_.string(); }

 private:
  std::filesystem::path path_;
};

}  // namespace understudy::calibration
