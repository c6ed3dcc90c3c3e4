#include <algorithm>
#include <numbers>

#include "kinematics/hexapod/hexapod_passive_rotation.h"

namespace understudy::kinematics {
namespace {

class Hexapod final : public Mechanism {
 public:
  Hexapod(const HexapodGeometry& geometry, const HexapodJoints& joints, const HexapodLimits& limits,
          const Pose& X_BT_home, const ScrewCoupling& coupling)
      : geometry_(geometry), joints_(joints), limits_(limits), X_BT_home_(X_BT_home), coupling_(coupling) {}

  int axis_count() const override { return kStruts; }
  std::string axis_name(int axis) const override { return "l" + std::to_string(axis + 1); }
  bool axis_is_angle(int) const override { return false; }
  AxisRange axis_range(int) const override { return {limits_.strut_min, limits_.strut_max}; }
  Pose home() const override { return X_BT_home_; }

  // One set of lengths for each pose: `previous` has nothing to choose.
  SolveStatus inverse(const Pose& X_BT, std::span<const double>, std::span<double> axes) const override {
    if (axes.size() < kStruts) return SolveStatus::bad_input;
    StrutLengths lengths;
    const SolveStatus status = kinematics::inverse(geometry_, coupling_, X_BT, lengths);
    if (status == SolveStatus::ok) std::copy(lengths.begin(), lengths.end(), axes.begin());
    return status;
  }

  SolveStatus forward(std::span<const double> axes, const Pose& seed, Pose& X_BT) const override {
    if (axes.size() < kStruts) return SolveStatus::bad_input;
    StrutLengths lengths;
    std::copy_n(axes.begin(), kStruts, lengths.begin());
    const ForwardResult result = kinematics::forward(geometry_, coupling_, lengths, seed);
    if (result.status == SolveStatus::ok) X_BT = result.X_BT;
    return result.status;
  }

  SolveStatus axis_rates(const Pose& X_BT, std::span<const double>,
                         Eigen::Ref<Eigen::Matrix<double, Eigen::Dynamic, 6>> rates) const override {
    if (rates.rows() < kStruts) return SolveStatus::bad_input;
    Mat6 J;
    const SolveStatus status = kinematics::jacobian(geometry_, X_BT, J);
    if (status != SolveStatus::ok) return status;
    rates.topRows<kStruts>() = J;
    return coupling_.lead == 0 ? SolveStatus::ok : add_screw_rates(X_BT, rates);
  }

  double condition_number(const Pose& X_BT, std::span<const double>) const override {
    return kinematics::condition_number(geometry_, X_BT);
  }

  void check(const Pose& X_BT, std::span<const double>,
             std::vector<LimitViolation>& violations) const override {
    kinematics::check(geometry_, joints_, limits_, X_BT, violations);
  }

 private:
  HexapodGeometry geometry_;
  HexapodJoints joints_;
  HexapodLimits limits_;
  /// The screws' turning moves the drives by a percent of what the struts do: a central difference of it is
  /// good to 1e-9 of the rates.
  SolveStatus add_screw_rates(const Pose& X_BT,
                              Eigen::Ref<Eigen::Matrix<double, Eigen::Dynamic, 6>> rates) const {
    constexpr double kStep = 1e-5;  // [m] or [rad]
    const double per_angle = coupling_.lead / (2 * std::numbers::pi);
    for (int k = 0; k < 6; ++k)
      for (int strut = 0; strut < kStruts; ++strut) {
        double before = 0, after = 0;
        for (double* angle : {&before, &after}) {
          const double step = angle == &after ? kStep : -kStep;
          Pose X = X_BT;
          if (k < 3)
            X.translation()[k] += step;
          else
            X.linear() = Eigen::AngleAxisd(step, Vec3::Unit(k - 3)).toRotationMatrix() * X.linear();
          const SolveStatus status = passive_rotation(geometry_, coupling_, X, strut, *angle);
          if (status != SolveStatus::ok) return status;
        }
        rates(strut, k) -= per_angle * (after - before) / (2 * kStep);
      }
    return SolveStatus::ok;
  }

  Pose X_BT_home_;
  ScrewCoupling coupling_;
};

}  // namespace

std::unique_ptr<Mechanism> make_hexapod(const HexapodGeometry& geometry, const HexapodJoints& joints,
                                        const HexapodLimits& limits, const Pose& X_BT_home) {
  return std::make_unique<Hexapod>(geometry, joints, limits, X_BT_home, ScrewCoupling{});
}

std::unique_ptr<Mechanism> make_hexapod(const HexapodGeometry& geometry, const HexapodJoints& joints,
                                        const HexapodLimits& limits, const Pose& X_BT_home,
                                        const ScrewCoupling& coupling) {
  return std::make_unique<Hexapod>(geometry, joints, limits, X_BT_home, coupling);
}

}  // namespace understudy::kinematics
