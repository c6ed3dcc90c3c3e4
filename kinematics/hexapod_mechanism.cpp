#include <algorithm>

#include "kinematics/hexapod.h"

namespace understudy::kinematics {
namespace {

class Hexapod final : public Mechanism {
 public:
  Hexapod(const HexapodGeometry& geometry, const HexapodJoints& joints, const HexapodLimits& limits,
          const Pose& X_BT_home)
      : geometry_(geometry), joints_(joints), limits_(limits), X_BT_home_(X_BT_home) {}

  int axis_count() const override { return kStruts; }
  std::string axis_name(int axis) const override { return "l" + std::to_string(axis + 1); }
  bool axis_is_angle(int) const override { return false; }
  Pose home() const override { return X_BT_home_; }

  // One set of lengths for each pose: `previous` has nothing to choose.
  Solve inverse(const Pose& X_BT, std::span<const double>, std::span<double> axes) const override {
    if (axes.size() < kStruts) return Solve::bad_input;
    StrutLengths lengths;
    const Solve status = kinematics::inverse(geometry_, X_BT, lengths);
    if (status == Solve::ok) std::copy(lengths.begin(), lengths.end(), axes.begin());
    return status;
  }

  Solve forward(std::span<const double> axes, const Pose& seed, Pose& X_BT) const override {
    if (axes.size() < kStruts) return Solve::bad_input;
    StrutLengths lengths;
    std::copy_n(axes.begin(), kStruts, lengths.begin());
    const ForwardResult result = kinematics::forward(geometry_, lengths, seed);
    if (result.status == Solve::ok) X_BT = result.X_BT;
    return result.status;
  }

  Solve axis_rates(const Pose& X_BT, std::span<const double>,
                   Eigen::Ref<Eigen::Matrix<double, Eigen::Dynamic, 6>> rates) const override {
    if (rates.rows() < kStruts) return Solve::bad_input;
    Mat6 J;
    const Solve status = kinematics::jacobian(geometry_, X_BT, J);
    if (status == Solve::ok) rates.topRows<kStruts>() = J;
    return status;
  }

  double condition_number(const Pose& X_BT, std::span<const double>) const override {
    return kinematics::condition_number(geometry_, X_BT);
  }

  void check(const Pose& X_BT, std::vector<LimitViolation>& violations) const override {
    kinematics::check(geometry_, joints_, limits_, X_BT, violations);
  }

 private:
  HexapodGeometry geometry_;
  HexapodJoints joints_;
  HexapodLimits limits_;
  Pose X_BT_home_;
};

}  // namespace

std::unique_ptr<Mechanism> make_hexapod(const HexapodGeometry& geometry, const HexapodJoints& joints,
                                        const HexapodLimits& limits, const Pose& X_BT_home) {
  return std::make_unique<Hexapod>(geometry, joints, limits, X_BT_home);
}

}  // namespace understudy::kinematics
