#include "control/registration/part_pose_file.h"

#include <cmath>

#include <fmt/format.h>

#include "core/file/read_file.h"
#include "core/text/printable.h"
#include "core/units.h"
#include "core/yaml/yaml_map.h"
#include "machine/file/covariance_key.h"
#include "machine/file/mount_key.h"
#include "machine/file/section_text.h"

namespace understudy::control {
namespace {

// What is clamped so far off was not clamped for this program.
constexpr double kShiftMost = 20e-3;        // [m]
constexpr double kTurnMost = 20 * kDegree;  // [rad]
constexpr const char* kCommand = "understudy register";

Eigen::VectorXd units() {
  Eigen::VectorXd units(6);
  units << Vec3::Constant(kMillimetre), Vec3::Ones();
  return units;
}

std::string text_if_given(YamlMap& map, const char* key, const char* about) {
  return map.has(key) ? map.text(key, about) : "";
}

void check_reach(const YamlMap& map, const PartPose& pose) {
  const double shift = (pose.X_W * pose.reference_W - pose.reference_W).norm();
  const double turn = log_rotation(pose.X_W.linear()).norm();
  if (shift > kShiftMost)
    throw InputError(map.place("part_mm"),
                     fmt::format("the part is shifted by {:.3f} mm, more than {:g} mm: clamp it where it was "
                                 "drawn, or place the program",
                                 to_mm(shift), to_mm(kShiftMost)));
  if (turn > kTurnMost)
    throw InputError(map.place("part_quaternion"),
                     fmt::format("the part is turned by {:.2f} degrees, more than {:g}: clamp it as it was "
                                 "drawn, or turn the program",
                                 to_deg(turn), to_deg(kTurnMost)));
}

void read(YamlMap& map, PartPose& pose) {
  pose.part = text_if_given(map, "part", "its name or file");
  pose.part_sha256 = text_if_given(map, "part_sha256", "checksum of its STL's bytes");
  pose.machine = text_if_given(map, "machine", "that found it: a name or file");
  pose.machine_sha256 = text_if_given(map, "machine_sha256", "checksum of the machine file's bytes");
  map.section("pose", "of the drawn part where it stands: a point p of it is at R p + part",
              [&](YamlMap& keys) {
                pose.X_W = machine::read_mount(keys, "part", "W");
                pose.reference_W =
                    keys.vector("reference_mm", {-5000, 5000}, "the point that the covariance is told at");
                const Eigen::MatrixXd covariance =
                    machine::read_covariance(keys, "covariance_mm_rad", units(), kCommand);
                if (keys.complete()) {
                  pose.covariance = covariance;
                  check_reach(keys, pose);
                }
              });
  if (map.has("unseen"))
    pose.unseen = map.texts("unseen", "freedoms that were not measured and are as drawn, in words");
}

}  // namespace

std::string write_part_pose(const PartPose& pose, const std::string& command) {
  std::string text =
      fmt::format("# Where the part stands: a point p of the drawn part is at R p + part, in W. By: {}\n",
                  printable(command, std::string::npos));
  const auto add = [&text](const char* key, const std::string& value) {
    if (!value.empty()) text += fmt::format("{}: {}\n", key, machine::quoted_text(value));
  };
  add("part", pose.part);
  add("part_sha256", pose.part_sha256);
  add("machine", pose.machine);
  add("machine_sha256", pose.machine_sha256);
  text += "pose:\n" + machine::mount_text("part", pose.X_W) +
          fmt::format("  reference_mm: {}   # the centre of the places\n",
                      machine::vector_text(pose.reference_W, kMillimetre)) +
          "  # Of the shift of the reference along x, y, z of W in mm, and of the turn about them in rad.\n" +
          machine::covariance_text("covariance_mm_rad", pose.covariance, units(), "the line above");
  if (pose.unseen.empty()) return text;
  text += "unseen:   # left as drawn\n";
  for (const std::string& freedom : pose.unseen)
    text += fmt::format("  - {}\n", machine::quoted_text(freedom));
  return text;
}

PartPose read_part_pose(const std::string& file) {
  PartPose pose;
  YamlMap::read_text(read_file(file), file, [&](YamlMap& map) { read(map, pose); });
  return pose;
}

MapSchema part_pose_schema() {
  return YamlMap::schema([](YamlMap& map) {
    PartPose pose;
    read(map, pose);
  });
}

}  // namespace understudy::control
