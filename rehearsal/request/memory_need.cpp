#include "rehearsal/request/memory_need.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "core/error.h"
#include "core/process/memory.h"
#include "machine/description.h"
#include "machine/fixture_file.h"

namespace understudy::rehearsal {
namespace fs = std::filesystem;
namespace {

// Peaks of `understudy rehearse` (docs/limits.md), rounded up: [bytes].
constexpr double kBase = 150e6, kBaseOfRun = 60e6;
constexpr double kLine = 300, kLineOfRun = 900;
constexpr double kTriangle = 300, kTriangleOfRun = 700;
constexpr double kMilled = 250e6;  // as many samples of the surface as there may be (sim/removal)
constexpr double kPixel = 160;     // of the gap sensor's microscope
constexpr double kGiga = 1e9;

/// Of a triangle in an STL file, at least: binary, and text without indentation.
constexpr double kBinaryTriangle = 50, kTextTriangle = 120;

double lines_in(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return 0;
  std::ifstream file(path, std::ios::binary);
  std::array<char, 1 << 16> chunk;
  double lines = 1;
  while (file.read(chunk.data(), chunk.size()), file.gcount() > 0)
    lines += static_cast<double>(std::count(chunk.begin(), chunk.begin() + file.gcount(), '\n'));
  return lines;
}

double triangles_in(const std::string& fixture) {
  if (fixture.empty()) return 0;
  std::error_code ignored;
  const fs::path path = machine::find_fixture(fixture);
  if (!fs::is_regular_file(path, ignored)) return 0;
  std::array<char, 5> head{};
  std::ifstream(path, std::ios::binary).read(head.data(), head.size());
  const bool text = std::string_view(head.data(), head.size()) == "solid";
  return static_cast<double>(fs::file_size(path, ignored)) / (text ? kTextTriangle : kBinaryTriangle);
}

/// Of the sensor that takes pictures of the gap, if any does.
double pixels_of(const RehearsalRequest& request) {
  if (request.gap_control == "off") return 0;
  const Camera camera = machine::load_machine(request.machine).microscope.camera;
  return 1.0 * camera.width * camera.height;
}

}  // namespace

double memory_need(const RehearsalRequest& request, int runs) {
  const double lines = lines_in(request.program);
  const double triangles = triangles_in(request.fixture) + triangles_in(request.surface.intended) +
                           triangles_in(request.surface.stock);
  const bool mills = request.surface.depth_of_cut_mm || !request.surface.stock.empty();
  return kBase + (mills ? kMilled : 0) + kPixel * pixels_of(request) + kLine * lines + kTriangle * triangles +
         runs * (kBaseOfRun + kLineOfRun * lines + kTriangleOfRun * triangles);
}

int runs_at_most(const RehearsalRequest& request) {
  const bool compared = request.compare_without_gap_control && request.gap_control != "off";
  return 1 + (compared ? 1 : 0) + (request.before.empty() ? 0 : 1);
}

void check_memory(const RehearsalRequest& request) {
  const double need = memory_need(request, runs_at_most(request));
  const auto available = static_cast<double>(available_memory());
  if (available > 0 && need > available)
    throw InputError(
        {request.program},
        fmt::format("needs about {:.1f} GB of memory, and {:.1f} GB are free: divide the program, or "
                    "take a coarser fixture or camera",
                    need / kGiga, available / kGiga));
}

}  // namespace understudy::rehearsal
