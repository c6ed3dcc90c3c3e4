// Chains whose tool hangs on rods: three slides on the frame, each of which holds one end of a rod of fixed
// length. The other ends carry the tool. Every rod is a pair of parallel ones, so the tool only translates.
//
// The joint of rod i on its slide is at C_i = point_i + q_i direction_i. Seen from there, the joint on the
// tool is as far as its tower's offset says; both offsets are the same in all poses, so `point` has them
// subtracted and all rods meet in one place p, with |p - C_i| = rods[i]. All positions in O.
#pragma once

#include <span>

#include "kinematics/chain/chain.h"

namespace understudy::kinematics {

constexpr int kRods = 3;

// For chains with rods; none of these throws or allocates.

/// Where the rods meet: of both points of the three spheres the one that the slides' directions lead away
/// from. `unreachable` where the spheres have none in common, or the joints on the slides lie on a line;
/// `p_O` is then the point nearest to it in their plane, and finite.
SolveStatus rods_meet(const Chain& chain, std::span<const double> slides, Vec3& p_O);

/// The slides that bring the rods' meeting point to p_O, each ahead of it: q_i = w d + sqrt(L^2 - |w|^2 +
/// (w d)^2) with w = p - point_i. `unreachable` where a rod is too short; `slides` then stay unchanged.
SolveStatus slides_of_rods(const Chain& chain, const Vec3& p_O, std::span<double> slides);

/// Along each rod, from its slide to where they meet; rows. [m]
Mat3 rod_vectors(const Chain& chain, std::span<const double> slides, const Vec3& p_O);

/// dp/d(slides), from u_i (p' - d_i q_i') = 0 for every rod u_i. Zero where the rods lie in a plane: there a
/// slide moves them apart.
Mat3 rod_jacobian(const Chain& chain, const Mat3& rods);

/// [rad], of a rod against the direction that its slide moves in; 0: the slide pushes straight along it.
double rod_lean(const Chain& chain, const Mat3& rods, int rod);

/// [m], from the line of a slide to a point: no more than its rod's length where it can be reached.
double rod_span(const Chain& chain, const Vec3& p_O, int rod);

}  // namespace understudy::kinematics
