#include <BulletDynamics/Featherstone/btMultiBodyPoint2Point.h>
#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/units.h"
#include "sim/plant/bullet/bullet_plant_base.h"
#include "sim/plant/bullet/bullet_plants.h"
#include "sim/plant/hexapod_assembly.h"
#include "sim/plant/joint_constants.h"
#include "sim/plant/strut_chain.h"

namespace understudy::sim {
namespace {

using kinematics::AxisVector;
using kinematics::kStruts;

Mat3 cube_inertia(double mass) { return cube_moment(mass) * Mat3::Identity(); }

/// Links of a strut in W: the cross and the motor of the universal joint, the nut, and the rod end where the
/// ball joint has play.
std::vector<BulletLink> strut_links(const StrutChain& chain, const machine::Masses& masses, double deviation,
                                    bool ball_play) {
  const double rod_end = ball_play ? kRodEndShare * masses.nut : 0.0, nut = masses.nut - rod_end;
  std::vector<BulletLink> links;
  links.push_back({-1, true, chain.tangent_W, chain.base_W, 0, chain.base_W, Mat3::Zero()});
  links.push_back({0, true, chain.offset_W, chain.base_W, masses.motor,
                   chain.base_W + deviation * chain.offset_W, cube_inertia(masses.motor)});
  links.push_back({1, false, chain.screw_W, chain.ball_W, nut, chain.ball_W, cube_inertia(nut)});
  if (ball_play)
    links.push_back({2, false, (chain.ball_W - chain.base_W).normalized(), chain.ball_W, rod_end,
                     chain.ball_W, cube_inertia(rod_end)});
  return links;
}

class BulletHexapod final : public BulletPlantBase {
 public:
  BulletHexapod(const machine::MachineDescription& machine, const AsBuilt& as_built,
                const BulletOptions& options)
      : BulletPlantBase(machine, options), as_built_(as_built), screws_(machine, as_built) {
    set_gravity(Vec3(0, 0, options.gravity ? -kGravity : 0));
    reset(home_displacement(machine, as_built));
  }

  void reset(const AxisVector& displacement) override;
  Pose tool_pose() const override {
    const Pose X_WC = link_pose(*platform_, -1);
    return make_pose(X_WC.linear(), X_WC * Vec3(-machine_.hexapod().masses.platform_centre_T));
  }
  double closure_error() const override { return closure_; }

 protected:
  void before_step() override { closure_ = largest_opening(); }
  double hidden_travel(int strut) const override { return screws_.growth(tool_pose(), strut); }
  void check_assembly() const override {
    if (!(closure_ <= kClosureLimit))
      throw MachineError(
          fmt::format("engine failure at {:.4f} s: a closed joint is {:.4f} mm apart, limit {} mm", time(),
                      to_mm(closure_), to_mm(kClosureLimit)));
    for (std::size_t i = 0; i < balls_.size(); ++i)
      if (balls_[i] != nullptr && !(balls_[i]->overrun() <= kClosureLimit))
        throw MachineError(
            fmt::format("engine failure at {:.4f} s: ball joint {} is {:.4f} mm beyond its play, limit {} mm",
                        time(), i + 1, to_mm(balls_[i]->overrun()), to_mm(kClosureLimit)));
  }

 private:
  struct Ball {
    const btMultiBody* strut;
    int link;
    btVector3 ball_L, ball_C;  ///< [m], in the strut's last link and from the platform's centre of mass
  };
  void add_strut(std::size_t strut, const Pose& X_WT, double displacement);
  double largest_opening() const;

  AsBuilt as_built_;
  ScrewTurning screws_;
  btMultiBody* platform_ = nullptr;
  PerStrut<Ball> closures_{};
  std::array<BulletPlay*, kStruts> balls_{};
  double closure_ = 0;
};

void BulletHexapod::reset(const AxisVector& displacement) {
  clear();
  const Pose X_WT = assemble_hexapod(machine_, as_built_, displacement);
  const machine::Masses& masses = machine_.hexapod().masses;
  platform_ =
      &add_body(make_floating_body(masses.platform, masses.platform_inertia,
                                   make_pose(Mat3(X_WT.linear()), Vec3(X_WT * masses.platform_centre_T))));
  for (std::size_t i = 0; i < kStruts; ++i) add_strut(i, X_WT, displacement[i]);
  settle(displacement);
}

void BulletHexapod::add_strut(std::size_t i, const Pose& X_WT, double displacement) {
  const StrutChain chain =
      assemble_strut(as_built_.hexapod, machine_.hexapod().joints, machine_.X_WB, X_WT, static_cast<int>(i));
  const double nut_play = options_.play ? as_built_.nut_play[i] : 0.0,
               ball_play = options_.play ? as_built_.ball_play[i] : 0.0,
               friction = machine_.hexapod().play.friction;
  const auto links =
      strut_links(chain, machine_.hexapod().masses, as_built_.hexapod.deviation, ball_play > 0);
  btMultiBody& strut = add_body(make_tree(links, Pose::Identity()));
  const int last = strut.getNumLinks() - 1;
  add_damping({&strut, 0, kHingeDamping});
  add_damping({&strut, 1, kHingeDamping});
  // The nut's slide reads 0 where the machine was assembled, with what the screw's turning has added.
  const double assembled = displacement + screws_.growth(X_WT, static_cast<int>(i));
  add_drive(strut, 2, displacement, -assembled, {nut_play, kPlayDamping, friction});
  balls_[i] = nullptr;
  if (ball_play > 0) {
    auto ball = std::make_unique<BulletPlay>(strut, last, nullptr,
                                             BulletPlay::Properties{ball_play, kPlayDamping, friction});
    balls_[i] = ball.get();
    add_constraint(std::move(ball));
  }
  closures_[i] = {
      &strut, last, strut.worldPosToLocal(last, to_bullet(chain.ball_W)),
      to_bullet(Vec3(as_built_.hexapod.platform_joint[i] - machine_.hexapod().masses.platform_centre_T))};
  add_constraint(std::make_unique<btMultiBodyPoint2Point>(&strut, last, platform_, -1, closures_[i].ball_L,
                                                          closures_[i].ball_C));
}

double BulletHexapod::largest_opening() const {
  double largest = 0;
  for (const Ball& closure : closures_) {
    const btVector3 apart = closure.strut->localPosToWorld(closure.link, closure.ball_L) -
                            platform_->localPosToWorld(-1, closure.ball_C);
    largest = std::max(largest, apart.length());
  }
  return largest;
}

}  // namespace

std::unique_ptr<Plant> make_bullet_hexapod(const machine::MachineDescription& machine,
                                           const AsBuilt& as_built, const BulletOptions& options) {
  return std::make_unique<BulletHexapod>(machine, as_built, options);
}

}  // namespace understudy::sim
