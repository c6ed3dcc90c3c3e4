#include "vision/boards/rig_file.h"

#include <cmath>
#include <filesystem>
#include <locale>
#include <sstream>

#include "core/error.h"
#include "core/file/read_file.h"
#include "core/units.h"
#include "core/yaml/map_schema.h"
#include "core/yaml/yaml_map.h"
#include "vision/boards/rig_measurement.h"

namespace understudy::vision {
namespace {

constexpr double kMilli = 1e-3;          // of mrad and permille
constexpr double kUnitTolerance = 1e-4;  // of a quaternion, as in G-code
constexpr double kLeastRadius = 8;       // [px], of a target whose outline can be measured
constexpr Bounds kPlace{-1e5, 1e5};      // [mm]

/// Writes numbers as YAML has them, whatever locale the program has chosen.
std::ostringstream plain_stream() {
  std::ostringstream stream;
  stream.imbue(std::locale::classic());
  return stream;
}

std::string short_number(double value) {
  std::ostringstream text = plain_stream();
  text << value;
  return text.str();
}

[[noreturn]] void fail(const YamlMap& map, const std::string& key, const std::string& what) {
  map.fail(key, map.path(key) + " " + what);
}

void read_camera(YamlMap& map, MountedCamera& mounted) {
  Camera& camera = mounted.camera;
  camera.width = map.integer("width_px", 64, 8192, "of the sensor");
  camera.height = map.integer("height_px", 64, 8192, "of the sensor");
  camera.focal_px =
      map.quantity("focal_px", {10, 1e6}, "focal length over the width of a pixel, as designed");
  const auto centre =
      map.quantities("centre_px", 2, {-10000, 20000}, "principal point; (0, 0) is the first pixel's middle");
  camera.centre_px = {centre[0], centre[1]};
  const auto bent =
      map.numbers("distortion", 4, {-10, 10}, "of the lens as far as known: k1, k2, p1, p2 (Brown)");
  camera.k1 = bent[0], camera.k2 = bent[1], camera.p1 = bent[2], camera.p2 = bent[3];
  const Vec3 place = map.vector("position_mm", kPlace, "of the lens, in W");
  const auto turn = map.numbers("quaternion_wxyz", 4, {-1, 1},
                                "R_WC: x to the right of the picture, y down, z away from the camera");
  const Quat q(turn[0], turn[1], turn[2], turn[3]);
  if (map.complete() && std::abs(q.norm() - 1) > kUnitTolerance)
    fail(map, "quaternion_wxyz", "has length " + short_number(q.norm()) + ", not 1 within 1e-4");
  if (map.complete()) mounted.X_WC = make_pose(q.normalized(), place);
}

void read_board(YamlMap& map, Board& board) {
  board.columns = map.integer("columns", 3, 200, "of inner corners, along the picture's rows");
  board.rows = map.integer("rows", 3, 200, "of inner corners, down the picture");
  board.square = map.quantity("square_mm", {0.1, 1000}, "side of a square");
  board.margin = map.quantity("margin_mm", {0, 1000}, "of white paper around the squares");
  if (map.complete() && (board.columns + board.rows) % 2 == 0)
    fail(map, "rows",
         "is " + std::to_string(board.rows) + " beside " + std::to_string(board.columns) +
             " columns; one must be odd and one even, or the board looks the same upside down");
}

void read_targets(YamlMap& map, CalibrationRig& rig) {
  rig.target_radius = map.quantity("radius_mm", {0.1, 500}, "of the spheres");
  std::size_t count = 0;
  map.list(
      "centres", rig.targets.size(), "the three spheres; the first is target 0",
      [&](YamlMap& target, std::size_t index) {
        const Vec3 centre = target.vector("centre_mm", {-5000, 5000}, "in T, whose origin is the nozzle tip");
        if (index < rig.targets.size()) rig.targets[index] = centre;
        count = index + 1;
      });
  if (!map.complete()) return;
  if (count != rig.targets.size())
    fail(map, "centres", "has " + std::to_string(count) + " targets, must have 3");
  const Vec3 a = rig.targets[1] - rig.targets[0], b = rig.targets[2] - rig.targets[0];
  if (!(a.cross(b).norm() > kMilli * std::max(a.squaredNorm(), b.squaredNorm())))
    fail(map, "centres", "lie in one line: a rotation about it would not be seen");
}

void read_uncertainty(YamlMap& map, CalibrationUncertainty& uncertainty) {
  uncertainty.boards.offset =
      map.quantity("board_offset_um", {0, 1e5}, "1 sigma of a board's place, each axis");
  uncertainty.boards.rotation =
      map.quantity("board_rotation_mrad", {0, 500}, "1 sigma of its rotation, each axis");
  uncertainty.boards.scale = map.quantity("board_scale_permille", {0, 100}, "1 sigma of its print's scale");
  if (map.has("board_print_permille"))
    uncertainty.boards.print_scale =
        map.quantity("board_print_permille", {0, 100},
                     "1 sigma of the scale that all layers of a camera share: one print");
  if (map.has("board_flatness_um"))
    uncertainty.boards.flatness =
        map.quantity("board_flatness_um", {0, 1e5}, "1 sigma of each number of the print's bow");
  uncertainty.corner_px = map.quantity("corner_px", {0, 10}, "1 sigma of a measured corner in u and v");
  uncertainty.principal_px =
      map.quantity("principal_point_px", {0, 1000}, "1 sigma of centre_px in u and v; 0: it is not known");
}

PictureName read_name(YamlMap& map, const std::string& key, PictureName (*name)(const std::string&),
                      const char* about) {
  const std::string pattern = map.text(key, about);
  if (!map.complete()) return {};
  try {
    return name(pattern);
  } catch (const InputError& e) {
    map.fail(key, map.path(key) + ": " + e.what());
  }
}

void check_sizes(const YamlMap& map, const CalibrationRig& rig) {
  const double nearest = rig.middle_distance - 0.5 * rig.layer_spacing * (rig.layers - 1);
  if (!(nearest > 0))
    fail(map, "layer_spacing_mm",
         "puts the nearest layer " + short_number(to_mm(nearest)) + " mm before the camera; must be above 0");
  for (int camera = 0; camera < 2; ++camera)
    if (const double radius = target_radius_px(rig, camera); radius < kLeastRadius)
      fail(map, "targets",
           "have a radius of " + short_number(radius) + " px in camera " + std::to_string(camera) +
               ", must have 8 px or more");
}

void read_rig(YamlMap& map, RigDescription& d) {
  std::size_t cameras = 0;
  map.list("cameras", d.rig.cameras.size(), "camera 0 and camera 1", [&](YamlMap& camera, std::size_t index) {
    MountedCamera extra;
    read_camera(camera, index < d.rig.cameras.size() ? d.rig.cameras[index] : extra);
    cameras = index + 1;
  });
  map.section("board", "the printed chessboard", [&](YamlMap& m) { read_board(m, d.rig.board); });
  d.rig.layers = map.integer("layers", 2, 200, "depths at which each camera sees the board");
  d.rig.layer_spacing = map.quantity("layer_spacing_mm", {0.01, 5000}, "from one layer to the next");
  d.rig.middle_distance = map.quantity("middle_distance_mm", {1, 1e5}, "from a camera to its middle layer");
  map.section("targets", "the spheres on the tool", [&](YamlMap& m) { read_targets(m, d.rig); });
  map.section("uncertainty", "how well this is known",
              [&](YamlMap& m) { read_uncertainty(m, d.uncertainty); });
  d.board_pictures =
      read_name(map, "board_pictures", board_picture_name, "file names, with {camera} and {layer}");
  d.pose_pictures =
      read_name(map, "pose_pictures", pose_picture_name, "file names, with {pose} and {camera}");
  if (!map.complete()) return;
  if (cameras != d.rig.cameras.size())
    fail(map, "cameras", "has " + std::to_string(cameras) + " cameras, must have 2");
  check_sizes(map, d.rig);
}

std::string list(std::initializer_list<double> values) {
  std::ostringstream text = plain_stream();
  text.precision(15);
  for (const double v : values) text << (text.tellp() > 0 ? ", " : "[") << (v == 0 ? 0.0 : v);
  return text.str() + "]";
}

/// In single quotes, as YAML has it.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("''") : std::string(1, c);
  return out + "'";
}

std::string list_mm(const Vec3& v) { return list({to_mm(v.x()), to_mm(v.y()), to_mm(v.z())}); }

}  // namespace

PictureName board_picture_name(const std::string& pattern) { return {pattern, {"camera", "layer"}}; }
PictureName pose_picture_name(const std::string& pattern) { return {pattern, {"pose", "camera"}}; }

std::string RigDescription::board_picture(int camera, int layer) const {
  return (std::filesystem::path(file).parent_path() / board_pictures.name({camera, layer})).string();
}

RigDescription load_rig(const std::string& file) {
  RigDescription description;
  description.file = file;
  YamlMap::read_text(read_file(file), file, [&](YamlMap& map) { read_rig(map, description); });
  return description;
}

MapSchema rig_schema() {
  return YamlMap::schema([](YamlMap& map) {
    RigDescription description;
    read_rig(map, description);
  });
}

std::string rig_yaml(const RigDescription& d, const std::string& comment) {
  std::ostringstream out = plain_stream();
  out.precision(15);
  out << "# " << comment << "\ncameras:\n";
  for (const MountedCamera& mounted : d.rig.cameras) {
    const Camera& c = mounted.camera;
    Quat q(mounted.X_WC.linear());
    if (q.w() < 0) q.coeffs() *= -1;
    out << "  - width_px: " << c.width << "\n    height_px: " << c.height << "\n    focal_px: " << c.focal_px
        << "\n    centre_px: " << list({c.centre_px.x(), c.centre_px.y()})
        << "\n    distortion: " << list({c.k1, c.k2, c.p1, c.p2})
        << "\n    position_mm: " << list_mm(mounted.X_WC.translation())
        << "\n    quaternion_wxyz: " << list({q.w(), q.x(), q.y(), q.z()}) << "\n";
  }
  const Board& b = d.rig.board;
  out << "board:\n  columns: " << b.columns << "\n  rows: " << b.rows << "\n  square_mm: " << to_mm(b.square)
      << "\n  margin_mm: " << to_mm(b.margin) << "\nlayers: " << d.rig.layers
      << "\nlayer_spacing_mm: " << to_mm(d.rig.layer_spacing)
      << "\nmiddle_distance_mm: " << to_mm(d.rig.middle_distance)
      << "\ntargets:\n  radius_mm: " << to_mm(d.rig.target_radius) << "\n  centres:\n";
  for (const Vec3& p_T : d.rig.targets) out << "    - centre_mm: " << list_mm(p_T) << "\n";
  const CalibrationUncertainty& u = d.uncertainty;
  out << "uncertainty:\n  board_offset_um: " << to_um(u.boards.offset)
      << "\n  board_rotation_mrad: " << u.boards.rotation / kMilli
      << "\n  board_scale_permille: " << u.boards.scale / kMilli;
  if (u.boards.print_scale > 0) out << "\n  board_print_permille: " << u.boards.print_scale / kMilli;
  if (u.boards.flatness > 0) out << "\n  board_flatness_um: " << to_um(u.boards.flatness);
  out << "\n  corner_px: " << u.corner_px << "\n  principal_point_px: " << u.principal_px
      << "\nboard_pictures: " << quoted(d.board_pictures.pattern())
      << "\npose_pictures: " << quoted(d.pose_pictures.pattern()) << "\n";
  return out.str();
}

}  // namespace understudy::vision
