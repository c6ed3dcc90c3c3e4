// A folder with a table and pictures of round spots, as a laboratory hands it in.
#pragma once

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "core/frames.h"
#include "tests/temporary_folder.h"

namespace understudy::calibration {

class DotFolder : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) const {
    const std::filesystem::path path = folder_ / name;
    std::ofstream(path, std::ios::binary) << text;
    return path.string();
  }

  /// A grey PGM with a Gaussian of the hexapod's dot; `peak` 0: dark.
  void draw(const std::string& name, const Vec2& at, int width = 640, int height = 480,
            double peak = 150) const {
    std::string text = "P5\n" + std::to_string(width) + " " + std::to_string(height) + "\n255\n";
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const double r2 = (Vec2(x, y) - at).squaredNorm() / (2.5 * 2.5);
        const double noise = (x * 7 + y * 13) % 5 - 2;
        text += static_cast<char>(static_cast<unsigned char>(12 + noise + peak * std::exp(-r2 / 2)));
      }
    write(name, text);
  }

  const TemporaryFolder folder_;
};

}  // namespace understudy::calibration
