#include "vision/boards/rig_pictures.h"

#include <algorithm>
#include <filesystem>
#include <tuple>

#include "core/error.h"
#include "vision/picture/picture_file.h"

namespace understudy::vision {
namespace {

constexpr int kCameras = 2;

std::vector<int> numbers_of(const PictureName& name, const std::string& file,
                            const RigDescription& description) {
  const auto numbers = name.numbers(file);
  if (!numbers)
    throw InputError({file, 0, 0},
                     "its name does not fit the pattern " + name.pattern() + " of " + description.file);
  return *numbers;
}

void check_camera(int camera, const std::string& file) {
  if (camera >= kCameras)
    throw InputError({file, 0, 0},
                     "is of camera " + std::to_string(camera) + "; the set-up has cameras 0 and 1");
}

/// Sorts, and refuses what occurs twice.
template <typename Picture, typename Key>
void in_order(std::vector<Picture>& pictures, const Key& key) {
  std::stable_sort(pictures.begin(), pictures.end(),
                   [&](const Picture& a, const Picture& b) { return key(a) < key(b); });
  const auto twice = std::adjacent_find(pictures.begin(), pictures.end(),
                                        [&](const Picture& a, const Picture& b) { return key(a) == key(b); });
  if (twice != pictures.end())
    throw InputError({std::next(twice)->file, 0, 0}, "shows what " + twice->file + " shows, by its name");
}

}  // namespace

std::vector<BoardPicture> board_pictures(const RigDescription& description,
                                         const std::vector<std::string>& files) {
  std::vector<BoardPicture> pictures;
  const int layers = description.rig.layers;
  if (files.empty()) {
    for (int camera = 0; camera < kCameras; ++camera)
      for (int layer = 0; layer < layers; ++layer)
        pictures.push_back({description.board_picture(camera, layer), camera, layer});
    return pictures;
  }
  for (const std::string& file : files) {
    const std::vector<int> numbers = numbers_of(description.board_pictures, file, description);
    check_camera(numbers[0], file);
    if (numbers[1] >= layers)
      throw InputError({file, 0, 0}, "is of layer " + std::to_string(numbers[1]) + "; " + description.file +
                                         " has layers 0 to " + std::to_string(layers - 1));
    pictures.push_back({file, numbers[0], numbers[1]});
  }
  in_order(pictures, [](const BoardPicture& p) { return std::tuple(p.camera, p.layer); });
  return pictures;
}

std::vector<PosePicture> pose_pictures(const RigDescription& description,
                                       const std::vector<std::string>& files) {
  std::vector<PosePicture> pictures;
  for (const std::string& file : files) {
    const std::vector<int> numbers = numbers_of(description.pose_pictures, file, description);
    if (numbers[0] < 1) throw InputError({file, 0, 0}, "is of pose 0; poses are numbered from 1");
    check_camera(numbers[1], file);
    pictures.push_back({file, numbers[0], numbers[1]});
  }
  in_order(pictures, [](const PosePicture& p) { return std::tuple(p.pose, p.camera); });
  return pictures;
}

std::vector<std::array<PosePicture, 2>> pose_picture_pairs(const RigDescription& description,
                                                           const std::vector<std::string>& files) {
  const std::vector<PosePicture> pictures = pose_pictures(description, files);
  std::vector<std::array<PosePicture, 2>> pairs;
  for (std::size_t i = 0; i < pictures.size(); i += 2) {
    const bool paired = i + 1 < pictures.size() && pictures[i + 1].pose == pictures[i].pose;
    if (!paired) {
      const int other = 1 - pictures[i].camera;
      const std::filesystem::path partner = description.pose_pictures.name({pictures[i].pose, other});
      throw InputError({pictures[i].file, 0, 0}, "is not paired: " + partner.filename().string() +
                                                     " of camera " + std::to_string(other) +
                                                     " is not among the pictures");
    }
    pairs.push_back({pictures[i], pictures[i + 1]});
  }
  return pairs;
}

Image read_rig_picture(const RigDescription& description, int camera, const std::string& file) {
  Image picture = read_picture(file);
  const Camera& sensor = description.rig.cameras[static_cast<std::size_t>(camera)].camera;
  if (picture.width() != sensor.width || picture.height() != sensor.height)
    throw InputError({file, 0, 0}, "has " + std::to_string(picture.width()) + " x " +
                                       std::to_string(picture.height()) + " px, must have the " +
                                       std::to_string(sensor.width) + " x " + std::to_string(sensor.height) +
                                       " px of camera " + std::to_string(camera) + " in " + description.file);
  return picture;
}

std::vector<MeasuredBoardPicture> measure_boards(const RigDescription& description,
                                                 const std::vector<BoardPicture>& pictures,
                                                 const std::function<void(std::size_t)>& done) {
  std::vector<MeasuredBoardPicture> boards;
  for (const BoardPicture& picture : pictures) {
    boards.push_back({picture, measure_board(read_rig_picture(description, picture.camera, picture.file),
                                             description.rig.board)});
    if (done) done(boards.size());
  }
  return boards;
}

std::vector<SeenBoard> seen_boards(const std::vector<MeasuredBoardPicture>& boards) {
  std::vector<SeenBoard> seen;
  for (const MeasuredBoardPicture& board : boards)
    if (board.seen.status == BoardStatus::ok)
      seen.push_back({board.picture.camera, board.picture.layer, board.seen.corners_px});
  return seen;
}

}  // namespace understudy::vision
