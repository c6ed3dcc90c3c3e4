#include "sim/strand/strand_frame.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace understudy::sim {
namespace {

constexpr double kDiameter = 0.4e-3, kYoung = 3e9, kShear = 1.1e9, kLoad = 1.5e-3;  // [m], [Pa], [Pa], [N/m]
constexpr double kSecondMoment = std::numbers::pi / 64 * kDiameter * kDiameter * kDiameter * kDiameter;
constexpr double kBending = kYoung * kSecondMoment;
constexpr double kLength = 10e-3;
constexpr int kElements = 8;

/// Along x, from the origin.
StrandFrame straight(const Vec3& load_W = Vec3(0, 0, -kLoad)) {
  StrandFrame frame({kDiameter, kYoung, kShear, load_W}, Vec3::Zero());
  for (int i = 1; i <= kElements; ++i) frame.append(Vec3(kLength * i / kElements, 0, 0));
  return frame;
}
const std::vector<double> kSolid(kElements, 0.0);

TEST(StrandFrame, ACantileverBendsByTheEulerBernoulliFormulae) {
  StrandFrame frame = straight();
  frame.hold_end(false);
  frame.step(kSolid);
  // Cubic elements with consistent loads are exact at their nodes.
  EXPECT_NEAR(-frame.displacement_W(kElements).z() / (kLoad * std::pow(kLength, 4) / (8 * kBending)), 1,
              1e-9);
  EXPECT_NEAR(frame.rotation_W(kElements).y() / (kLoad * std::pow(kLength, 3) / (6 * kBending)), 1, 1e-9);
  EXPECT_EQ(frame.displacement_W(0).norm() + frame.rotation_W(0).norm(), 0) << "the first node is clamped";
}

TEST(StrandFrame, ABeamClampedAtBothEndsSagsInItsMiddle) {
  StrandFrame frame = straight();
  frame.step(kSolid);
  EXPECT_NEAR(-frame.displacement_W(kElements / 2).z() / (kLoad * std::pow(kLength, 4) / (384 * kBending)), 1,
              1e-9);
  EXPECT_EQ(frame.displacement_W(kElements).norm(), 0);
}

TEST(StrandFrame, ASupportHoldsItsPlaceAndLetsItTurn) {
  StrandFrame frame = straight();
  frame.support(kElements);
  frame.hold_end(false);
  frame.step(kSolid);
  // Clamped and propped: the prop's end turns by q L^3 / 48 E I.
  EXPECT_LE(frame.displacement_W(kElements).norm(), 1e-15);
  EXPECT_NEAR(std::abs(frame.rotation_W(kElements).y()) / (kLoad * std::pow(kLength, 3) / (48 * kBending)), 1,
              1e-9);
}

TEST(StrandFrame, ALoadAlongItStretchesIt) {
  StrandFrame frame = straight(Vec3(kLoad, 0, 0));
  frame.hold_end(false);
  frame.step(kSolid);
  const double area = std::numbers::pi / 4 * kDiameter * kDiameter;
  EXPECT_NEAR(frame.displacement_W(kElements).x() / (kLoad * kLength * kLength / (2 * kYoung * area)), 1,
              1e-9);
}

TEST(StrandFrame, BendingDoesNotDependOnTheDirectionOfTheStrand) {
  const Mat3 R = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  StrandFrame turned({kDiameter, kYoung, kShear, R * Vec3(0, 0, -kLoad)}, Vec3::Zero());
  for (int i = 1; i <= kElements; ++i) turned.append(R * Vec3(kLength * i / kElements, 0, 0));
  StrandFrame frame = straight();
  for (StrandFrame* f : {&turned, &frame}) {
    f->hold_end(false);
    f->step(kSolid);
  }
  const double tip = frame.displacement_W(kElements).norm();
  EXPECT_LE((turned.displacement_W(kElements) - R * frame.displacement_W(kElements)).norm(), 1e-9 * tip);
}

TEST(StrandFrame, ASteadyCreepAddsItsShareOfTheElasticDeflection) {
  // A Maxwell beam whose forces are fixed by equilibrium: w = w_elastic (1 + E phi t).
  StrandFrame frame = straight();
  frame.hold_end(false);
  const double creep = 0.01 / kYoung;  // [1/Pa] in each step
  const double elastic = kLoad * std::pow(kLength, 4) / (8 * kBending);
  constexpr int kSteps = 50;
  for (int k = 0; k < kSteps; ++k) frame.step(std::vector<double>(kElements, creep));
  // Implicit steps: the load of the first step creeps in it as well.
  EXPECT_NEAR(-frame.displacement_W(kElements).z() / elastic, 1 + 0.01 * kSteps, 1e-9);
  frame.step(kSolid);
  // The last element is settled by the one that follows it.
  const Vec3 solid = frame.displacement_W(kElements - 1);
  frame.step(std::vector<double>(kElements, creep));
  EXPECT_LE((frame.displacement_W(kElements - 1) - solid).norm(), 1e-9 * elastic)
      << "what was solid once creeps no more";
}

TEST(StrandFrame, AHorizontalRightAngleTwistsItsFirstLeg) {
  // The second leg's weight, at half its length, is a torque on the first: it turns by q L^2/2 L / (G J).
  StrandFrame frame({kDiameter, kYoung, kShear, Vec3(0, 0, -kLoad)}, Vec3::Zero());
  for (int i = 1; i <= kElements; ++i) frame.append(Vec3(kLength * i / kElements, 0, 0));
  for (int i = 1; i <= kElements; ++i) frame.append(Vec3(kLength, kLength * i / kElements, 0));
  frame.hold_end(false);
  frame.step(std::vector<double>(2 * kElements, 0.0));
  const double torsion = kShear * 2 * kSecondMoment;
  EXPECT_NEAR(-frame.rotation_W(kElements).x() / (kLoad * std::pow(kLength, 3) / (2 * torsion)), 1, 1e-9);
}

}  // namespace
}  // namespace understudy::sim
