// Bytes as the place of a part, as `register` writes it.
#include <algorithm>
#include <cctype>

#include "control/registration/part_pose_file.h"
#include "tests/fuzz/reader.h"

namespace understudy::fuzz {
namespace {

/// Names are for people: a control character is written as a question mark.
std::string as_written(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, '?');
  return name;
}

void require_same(const std::string& read, const std::string& written) {
  require(read == as_written(written), "another name came back: " + read);
}

}  // namespace
}  // namespace understudy::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understudy;
  static const fuzz::InputFile input("pose.yaml"), written("written.yaml");
  const std::string file = input.fill(fuzz::text_of(data, size)).string();
  control::PartPose pose;
  if (!fuzz::accepts(size, file, [&] { pose = control::read_part_pose(file); })) return 0;
  fuzz::require_finite(pose.X_W, "pose");
  fuzz::require_finite(pose.reference_W, "reference");
  fuzz::require(pose.covariance.allFinite(), "a covariance that is not finite");
  const control::PartPose again =
      control::read_part_pose(written.fill(control::write_part_pose(pose, "a fuzzer")).string());
  fuzz::require_same(again.part, pose.part);
  fuzz::require_same(again.machine, pose.machine);
  fuzz::require(again.unseen.size() == pose.unseen.size(), "other freedoms came back");
  for (std::size_t i = 0; i < pose.unseen.size(); ++i) fuzz::require_same(again.unseen[i], pose.unseen[i]);
  // Written to 1e-9 mm and 1e-12 of a quaternion.
  fuzz::require_near((again.X_W.translation() - pose.X_W.translation()).norm(), 0, 1e-11, 1e-12, "place");
  fuzz::require_near(angle_between(again.X_W.linear(), pose.X_W.linear()), 0, 3e-8, 0, "turn");
  return 0;
}
