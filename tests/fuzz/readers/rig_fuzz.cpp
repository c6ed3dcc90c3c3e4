// Bytes as the description of a measuring set-up.
#include "tests/fuzz/reader.h"
#include "vision/boards/rig_file.h"

namespace understudy::fuzz {
namespace {

void check_same(const vision::RigDescription& read, const vision::RigDescription& written) {
  constexpr double kDigits = 1e-12;  // of 15
  for (std::size_t i = 0; i < written.rig.cameras.size(); ++i) {
    const auto &r = read.rig.cameras[i], &w = written.rig.cameras[i];
    require(r.camera.width == w.camera.width && r.camera.height == w.camera.height,
            "another sensor came back");
    require_near(r.camera.focal_px, w.camera.focal_px, 0, kDigits, "focal length");
    require_near(r.camera.k1, w.camera.k1, 0, kDigits, "k1");
    require_near((r.X_WC.translation() - w.X_WC.translation()).norm(), 0, 1e-10, 0, "place of a camera");
    require_near(angle_between(r.X_WC.linear(), w.X_WC.linear()), 0, 1e-7, 0, "turn of a camera");
  }
  require(read.rig.board.columns == written.rig.board.columns, "another board came back");
  require(read.rig.layers == written.rig.layers, "another number of layers came back");
  require_near(read.rig.layer_spacing, written.rig.layer_spacing, 0, kDigits, "spacing");
  require_near(read.uncertainty.corner_px, written.uncertainty.corner_px, 0, kDigits, "corner_px");
  require(read.board_pictures.pattern() == written.board_pictures.pattern(),
          "another name of pictures came back");
  require(read.pose_pictures.pattern() == written.pose_pictures.pattern(),
          "another name of pictures came back");
}

}  // namespace
}  // namespace understudy::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understudy;
  static const fuzz::InputFile input("rig.yaml"), written("written.yaml");
  const std::string file = input.fill(fuzz::text_of(data, size)).string();
  vision::RigDescription rig;
  if (!fuzz::accepts(size, file, [&] { rig = vision::load_rig(file); })) return 0;
  for (const auto& camera : rig.rig.cameras) fuzz::require_finite(camera.X_WC, "camera");
  // A picture's name gives its numbers back.
  const auto numbers = rig.board_pictures.numbers(rig.board_picture(1, 1));
  fuzz::require(numbers == std::vector{1, 1}, "a picture's name does not give its numbers back");
  written.fill(vision::rig_yaml(rig, "written"));
  fuzz::check_same(vision::load_rig(written.path().string()), rig);
  return 0;
}
