// Bytes as each of the tables that name pictures: corners and targets of two cameras, the dot over flats.
#include "calibration/bundle/bundle_tables.h"
#include "calibration/gap_sensor/gap_picture_table.h"
#include "tests/fuzz/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understudy;
  static const fuzz::InputFile input("table.csv");
  const std::string file = input.fill(fuzz::text_of(data, size)).string();
  vision::CalibrationRig rig;
  rig.board = {3, 4, 10e-3, 0};  // small, so that a file of all its corners is
  rig.layers = 2;

  std::vector<vision::SeenBoard> boards;
  if (fuzz::accepts(size, file, [&] { boards = calibration::read_corners(file, rig); }))
    for (const auto& board : boards) {
      fuzz::require(board.corners_px.size() == static_cast<std::size_t>(rig.board.corners()),
                    "a board lacks corners");
      for (const auto& corner : board.corners_px) fuzz::require(corner.allFinite(), "a corner that is none");
    }

  std::vector<calibration::PoseTargets> poses;
  if (fuzz::accepts(size, file, [&] { poses = calibration::read_targets(file); }))
    for (const auto& pose : poses)
      fuzz::require(pose.pose >= 1 && pose.found >= 1 && pose.found <= 6, "a pose");

  calibration::GapPictureTable gaps;
  if (fuzz::accepts(size, file, [&] { gaps = calibration::read_gap_pictures(file); })) {
    fuzz::require(!gaps.known.empty(), "no gap is known");
    for (const auto& row : gaps.rows) {
      fuzz::require_finite(std::vector{row.height, row.height_sigma}, "height");
      fuzz::require(row.flat >= 0 && row.flat < std::ssize(gaps.slopes), "a flat that is not there");
    }
  }
  return 0;
}
