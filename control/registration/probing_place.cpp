#include "control/registration/probing_place.h"

#include <algorithm>

#include <fmt/format.h>

#include "control/gap/gap_reading.h"
#include "control/gap/local_surface.h"
#include "control/registration/tool_clearance.h"
#include "core/error.h"
#include "core/units.h"

namespace understudy::control {
namespace {

constexpr double kAirMin = 1e-3;     // [m], between tool and part, beside what the part may be off
constexpr double kAtTip = 3e-3;      // [m]: nearer to the tip the part is smooth, as the local surface says
constexpr double kRetreat = 10e-3;   // [m], along the tool axis, before the tool goes up
constexpr double kOverPart = 10e-3;  // [m], at which the tool travels
constexpr double kSurfaceSpacing = 2e-3;  // [m], of the points that stand for the part
constexpr double kStandoffMax = 3.5e-3;   // [m]: farther, the dot leaves the picture
constexpr int kLooks = 4;                 // at the tool's bodies on each stretch of the way

}  // namespace

Pose ProbingPlace::X_WT(double height) const {
  return make_pose(shortest_arc_from_z(normal_W), p_W + height * normal_W);
}

ProbingCheck::ProbingCheck(const machine::MachineDescription& machine, const geometry::Mesh& part,
                           double margin)
    : machine_(machine),
      part_(part),
      margin_(margin),
      standoff_(std::min(kStandoffMax, std::max(machine.gap.standoff, margin + kAirMin))),
      clear_height_(part.upper().z() + kOverPart + margin),
      mechanism_(machine.make_mechanism()),
      surface_W_(cover(part, kSurfaceSpacing)) {
  if (margin + kAirMin > kStandoffMax)
    throw InputError(
        fmt::format("by its tolerances the part may stand {:.2f} mm beside its place (4 sigma), and the gap "
                    "sensor looks down "
                    "from {:.2f} mm at most: clamp it more exactly, or state smaller tolerances of the part",
                    to_mm(margin), to_mm(kStandoffMax - kAirMin)));
}

ProbingCheck::~ProbingCheck() = default;

ProbingWay ProbingCheck::way_to(const ProbingPlace& place) const {
  ProbingWay way{place.X_WT(kRetreat), place.X_WT(kRetreat), place.X_WT(standoff_)};
  way.above.translation().z() = std::max(way.above.translation().z(), clear_height_);
  return way;
}

std::string ProbingCheck::why_out_of_reach(const Pose& X_WT) const {
  const Pose X_BT = machine_.X_WB.inverse() * X_WT;
  kinematics::AxisVector axes{};
  const std::span<double> used(axes.data(), static_cast<std::size_t>(mechanism_->axis_count()));
  const auto solved = mechanism_->inverse(X_BT, {}, used);
  const bool known = solved == kinematics::SolveStatus::ok ||
                     (solved == kinematics::SolveStatus::singular && !mechanism_->follows_spin());
  std::vector<kinematics::LimitViolation> violations;
  mechanism_->check(X_BT, known ? std::span<const double>(used) : std::span<const double>(), violations);
  if (!violations.empty()) return to_string(violations.front());
  return known ? "" : std::string("the tool pose is ") + to_string(solved);
}

bool ProbingCheck::sees(const Pose& X_WT, const Vec3& dot_W, const Vec3& normal_W) const {
  constexpr double kOff = 20e-6;  // [m], from the surface: a ray does not hit where it begins
  const Vec3 from = dot_W + kOff * normal_W;
  for (const Vec3& device_T :
       {Vec3(machine_.laser.X_TL.translation()), Vec3(machine_.microscope.X_TC.translation())}) {
    const Vec3 way = X_WT * device_T - from;
    if (part_.ray_hit(from, way.normalized(), way.norm())) return false;
  }
  return true;
}

std::string ProbingCheck::why_not(const ProbingPlace& place) const {
  const ProbingWay way = way_to(place);
  // As deep as the part may lie, too.
  const Pose at = place.X_WT(0), deepest = place.X_WT(-margin_);
  for (const Pose& X_WT : {deepest, way.start, way.near, way.above})
    if (const std::string why = why_out_of_reach(X_WT); !why.empty()) return "out of reach: " + why;
  const auto surface = find_local_surface(part_, at);
  if (!surface) return fmt::format("the part ends or is not smooth within {:g} mm", to_mm(kSurfaceRadius));
  Vec3 dot_T;
  Vec2 pixel;
  for (const double height : {machine_.gap.aim, standoff_ + margin_})
    if (!predict_dot(machine_, *surface, height, pixel) || !dot_place(machine_, *surface, height, dot_T))
      return "the dot would lie outside the picture";
  if (!dot_place(machine_, *surface, machine_.gap.aim, dot_T)) return "the beam would miss the part";
  const Pose X_WT = place.X_WT(machine_.gap.aim);
  if (!sees(X_WT, X_WT * dot_T, place.normal_W)) return "the part hides the dot";
  const double air = kAirMin + margin_;
  if (tool_clearance(machine_, surface_W_, at, kAtTip) < kAirMin)
    return fmt::format("the tool would come nearer than {:g} mm to the part or the table", to_mm(kAirMin));
  for (const auto& [from, to] : {std::pair(way.near, way.start), std::pair(way.above, way.near)})
    for (int i = 0; i < kLooks; ++i)
      if (tool_clearance(machine_, surface_W_, interpolate(from, to, static_cast<double>(i) / kLooks), 0) <
          air)
        return fmt::format("on its way the tool would come nearer than {:.3g} mm to the part or the table",
                           to_mm(air));
  return "";
}

}  // namespace understudy::control
