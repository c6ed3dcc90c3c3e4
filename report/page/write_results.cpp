#include "report/page/write_results.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/file/output_file.h"
#include "core/parallel.h"
#include "core/units.h"
#include "report/page/report_data.h"
#include "report/page/report_html.h"
#include "report/picture/png.h"
#include "report/summary_json.h"
#include "report/trace/trace_csv.h"
#include "sim/removal/removal.h"

namespace understudy::report {
namespace fs = std::filesystem;
namespace {

std::string pixel_cells(bool present, const Vec2& p) {
  return present ? fmt::format("{:.3f},{:.3f}", p.x(), p.y()) : ",";
}

// What was seen beside what was there. The dot's pixels are on the sensor; the picture starts at x_px, y_px.
std::string frames_csv(const std::vector<rehearsal::FrameRecord>& frames) {
  std::string text =
      "picture,time_s,x_px,y_px,dot,measured_x_px,measured_y_px,true_x_px,true_y_px,reading_mm,sigma_um,"
      "true_gap_mm,used\n";
  int number = 0;
  for (const rehearsal::FrameRecord& frame : frames) {
    const control::GapSample& look = frame.look;
    const Region& region = look.frame.image.region;
    const bool read = look.reading.sigma > 0;
    text += fmt::format("approach-{:02}.png,{:.6f},{},{},{},{},{},{},{},{},{}\n", ++number, look.time,
                        region.x, region.y, vision::to_string(look.dot.status),
                        pixel_cells(look.dot.status != vision::DotStatus::no_dot, look.dot.position_px),
                        pixel_cells(frame.true_dot_px.has_value(), frame.true_dot_px.value_or(Vec2::Zero())),
                        read ? fmt::format("{:.6f}", to_mm(look.reading.gap)) : "",
                        read ? fmt::format("{:.3f}", to_um(look.reading.sigma)) : "",
                        std::isfinite(frame.true_gap) ? fmt::format("{:.6f}", to_mm(frame.true_gap)) : "",
                        look.used ? 1 : 0);
  }
  return text;
}

void write_frames(const std::vector<rehearsal::FrameRecord>& frames, const fs::path& folder) {
  fs::create_directory(folder);
  write_file(folder / "approach.csv", frames_csv(frames));
  int number = 0;
  for (const rehearsal::FrameRecord& frame : frames) {
    ++number;
    if (frame.look.frame.image.pixels.empty()) continue;  // the camera delivered nothing
    write_file(folder / fmt::format("approach-{:02}.png", number), encode_png(frame.look.frame.image));
  }
}

void write_tables(const rehearsal::Record& record, const fs::path& folder) {
  write_file(folder / "summary.json", summary_json(record));
  if (record.timing) write_file(folder / kTimingFile, timing_json(record));
  if (!record.as_built.empty()) write_file(folder / "as-built.yaml", record.as_built);
  if (!record.trace.empty()) {
    write_file(folder / "trace.csv", [&](const AppendPiece& append) { make_trace_csv(record, append); });
  }
  if (record.milled) {
    const auto& [samples, before, after] = *record.milled;
    write_file(folder / "surface-before.ply", sim::surface_ply(samples, before, "surface of the stock"));
    write_file(folder / "surface-after.ply", sim::surface_ply(samples, after, "surface as milled"));
  }
  if (!record.frames.empty()) write_frames(record.frames, folder / "frames");
}

}  // namespace

DrawPictures pictures_of(const rehearsal::Record& record) {
  if (!record.scene) return {};
  return [&scene = *record.scene] { return draw_scene(scene); };
}

void write_results(const rehearsal::Record& record, const DrawPictures& draw, const fs::path& folder) {
  std::vector<Illustration> pictures;
  nlohmann::ordered_json data;
  in_parallel(2, 2, [&](std::size_t job) {
    if (job == 0) {
      if (draw) pictures = draw();
      return;
    }
    write_tables(record, folder);
    data = report_data(record);
  });
  data["pictures"] = pictures_value(pictures);
  write_file(folder / "report.html", report_html(record, data));
  if (pictures.empty()) return;
  fs::create_directory(folder / "pictures");
  int number = 0;
  for (const Illustration& illustration : pictures)
    write_file(folder / "pictures" / fmt::format("picture-{:02}.png", ++number), illustration.png);
}

}  // namespace understudy::report
