// The peer: LinuxCNC's general hexapod kinematics, genhexkins (Debian package linuxcnc-uspace), loaded when
// it is installed. Lengths go in and out in millimetres and angles in degrees of roll, pitch and yaw, as in
// its own configurations; it knows no deviation of the screw from the base joint.
#pragma once

#include <memory>
#include <string>

#include "kinematics/hexapod/hexapod.h"

namespace understudy::bench {

class Genhexkins {
 public:
  /// X Y Z [mm], A B C [deg]: the layout of its pose, whose last three are unused.
  struct World {
    double x = 0, y = 0, z = 0, a = 0, b = 0, c = 0, u = 0, v = 0, w = 0;
  };

  /// nullptr where the module is not installed or does not load; `reason` says why.
  static std::unique_ptr<Genhexkins> load(const kinematics::HexapodGeometry& geometry, std::string& reason);

  /// 0 where it succeeds. Lengths in [mm].
  int inverse(const World& world, double* lengths) const {
    return inverse_(&world, lengths, &flags_, &flags_out_);
  }
  /// `world` is the starting guess and the answer.
  int forward(const double* lengths, World& world) const {
    return forward_(lengths, &world, &flags_, &flags_out_);
  }

  static World world_of(const Pose& X_BT);
  static Pose pose_of(const World& world);

 private:
  using Inverse = int (*)(const World*, double*, const unsigned long*, unsigned long*);
  using Forward = int (*)(const double*, World*, const unsigned long*, unsigned long*);
  Inverse inverse_ = nullptr;
  Forward forward_ = nullptr;
  unsigned long flags_ = 0;
  mutable unsigned long flags_out_ = 0;
};

}  // namespace understudy::bench
