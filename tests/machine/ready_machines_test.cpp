// The machines of models/ that are chains of listed axes: their forward kinematics against closed forms,
// written out here from the sources that their files name. Numbers are those of the sources, in mm and
// degrees.
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "core/random.h"
#include "core/units.h"
#include "kinematics/chain/chain.h"
#include "machine/description.h"

namespace understudy::machine {
namespace {

constexpr double kFar = 1e-9;  // [m], and of a direction: what kinematics of a machine may be off by

/// The tip in mm and the tool's axis, seen from the work.
struct Tool {
  Vec3 tip_mm, axis;
};

double sine(double deg) { return std::sin(from_deg(deg)); }
double cosine(double deg) { return std::cos(from_deg(deg)); }
Vec3 about_z(double deg, const Vec3& v) {
  return {cosine(deg) * v.x() - sine(deg) * v.y(), sine(deg) * v.x() + cosine(deg) * v.y(), v.z()};
}

/// Axes by the letters that drive them, in mm and degrees.
using Letters = std::map<char, double>;
using Closed = std::function<Tool(const Letters&)>;

// LinuxCNC's trtfuncs.c with y-offset 20 and z-offset 10 (xyzac-trt.ini).
Tool trunnion_ac(const Letters& q) {
  const double dy = 20, dz = 10, a = q.at('A'), y = q.at('Y') - dy, z = q.at('Z') - dz;
  const Vec3 tilted(q.at('X'), cosine(a) * y + sine(a) * z + dy, -sine(a) * y + cosine(a) * z + dz);
  return {about_z(-q.at('C'), tilted), about_z(-q.at('C'), {0, sine(a), cosine(a)})};
}

Tool bc(double dx, double dz, double b, double c, const Letters& q) {
  const double x = q.at('X') - dx, z = q.at('Z') - dz;
  const Vec3 tilted(cosine(b) * x - sine(b) * z + dx, q.at('Y'), sine(b) * x + cosine(b) * z + dz);
  return {about_z(-c, tilted), about_z(-c, {-sine(b), 0, cosine(b)})};
}

// The same file with x-offset -20 and z-offset -15 (xyzbc-trt.ini).
Tool trunnion_bc(const Letters& q) { return bc(-20, -15, q.at('B'), q.at('C'), q); }

// U about a line 45 mm below the bed, V about the bed's own.
Tool open5x(const Letters& q) { return bc(0, -45, q.at('U'), q.at('V'), q); }

// LinuxCNC's maxkins.c, its directions unconventional, with a pivot 60 mm above the tip.
Tool head_table(const Letters& q) {
  const double b = q.at('B'), length = 60;
  const Vec3 p(q.at('X') + length * sine(b), q.at('Y'), q.at('Z') + length * (1 - cosine(b)));
  return {about_z(q.at('C'), p), about_z(q.at('C'), {-sine(b), 0, cosine(b)})};
}

// LinuxCNC's 5axiskins.c: a pivot 250 mm above the tip.
Tool head_head(const Letters& q) {
  const double b = q.at('B'), c = q.at('C'), length = 250;
  return {{q.at('X') + length * sine(b) * cosine(c), q.at('Y') + length * sine(b) * sine(c),
           q.at('Z') + length * (1 - cosine(b))},
          {-sine(b) * cosine(c), -sine(b) * sine(c), cosine(b)}};
}

// 45 degrees; at A 90 the nozzle leans to +x.
Tool tilted_nozzle(const Letters& q) {
  return {{q.at('X'), q.at('Y'), q.at('Z')},
          {std::sqrt(0.5) * sine(q.at('A')), -std::sqrt(0.5) * cosine(q.at('A')), std::sqrt(0.5)}};
}

struct ReadyMachine {
  const char* name;
  const char* letters;  // of the slides' and the turns' words
  Closed closed;
};

class ReadyMachines : public testing::TestWithParam<ReadyMachine> {};

TEST_P(ReadyMachines, ForwardKinematicsIsThatOfTheirSource) {
  const MachineDescription machine = load_machine(GetParam().name);
  const kinematics::ChainDescription& chain = machine.chain().kinematics;
  const auto mechanism = machine.make_mechanism();
  Random random(61, GetParam().name);
  for (int n = 0; n < 500; ++n) {
    Letters letters;
    kinematics::AxisVector axes = chain.home;
    const auto draw = [&](const kinematics::AxisWord& word, double unit, double most) {
      letters[word.letter] = random.uniform(-most, most);
      axes[word.axis] = word.position(unit * letters[word.letter]);
    };
    for (const auto& word : chain.slide_words) draw(word, kMillimetre, 100);
    for (const auto& word : chain.turn_words) draw(word, kDegree, 170);
    std::string named;
    for (const auto& [letter, value] : letters) named += letter;
    ASSERT_EQ(named, GetParam().letters);
    const Tool expected = GetParam().closed(letters);
    const Pose X_ST = kinematics::forward(chain.chain, axes);
    EXPECT_LE((X_ST.translation() - from_mm(1) * expected.tip_mm).norm(), kFar) << n;
    EXPECT_LE((tool_axis(X_ST) - expected.axis).norm(), kFar) << n;
    // And so do the words of a program.
    Pose by_words;
    kinematics::RotaryTarget target;
    for (int i = 0; i < 3; ++i) target.p_BT[i] = from_mm(letters["XYZ"[i]]);
    target.b = from_deg(letters[chain.turn_words[0].letter]);
    if (chain.turn_words.size() > 1) target.c = from_deg(letters[chain.turn_words[1].letter]);
    ASSERT_EQ(mechanism->pose_at_slides(target, by_words), kinematics::SolveStatus::ok);
    EXPECT_LE((by_words.matrix() - X_ST.matrix()).norm(), kFar) << n;
  }
}

INSTANTIATE_TEST_SUITE_P(Models, ReadyMachines,
                         testing::Values(ReadyMachine{"trunnion-ac", "ACXYZ", trunnion_ac},
                                         ReadyMachine{"trunnion-bc", "BCXYZ", trunnion_bc},
                                         ReadyMachine{"open5x", "UVXYZ", open5x},
                                         ReadyMachine{"head-table", "BCXYZ", head_table},
                                         ReadyMachine{"head-head", "BCXYZ", head_head},
                                         ReadyMachine{"tilted-nozzle", "AXYZ", tilted_nozzle}),
                         [](const auto& one) {
                           std::string name = one.param.name;
                           std::erase(name, '-');
                           return name;
                         });

TEST(ReadyMachinesWithoutTurns, CoreXyMovesItsTipOverABedThatSinks) {
  const MachineDescription machine = load_machine("corexy");
  const kinematics::Chain& chain = machine.chain().kinematics.chain;
  ASSERT_EQ(chain.size(), 3);
  EXPECT_EQ(chain.axes[0].name + chain.axes[1].name + chain.axes[2].name, "yxz");
  const std::array<double, 3> axes{0.012, -0.034, 0.056};  // y x z
  EXPECT_LE((kinematics::forward(chain, axes).translation() - Vec3(-0.034, 0.012, 0.056)).norm(), kFar);
}

// Anycubic Kossel Linear Plus: the tip at the crossing of three rods of 267 mm, whose joints hang 134.4 mm
// from the middle at 210, 330 and 90 degrees; the joints on the tool are 40 mm above the tip.
TEST(ReadyMachinesWithoutTurns, DeltaHangsItsTipOnThreeRods) {
  const MachineDescription machine = load_machine("delta");
  const kinematics::Chain& chain = machine.chain().kinematics.chain;
  ASSERT_EQ(chain.size(), 3);
  Random random(64, "delta");
  for (int n = 0; n < 500; ++n) {
    const Vec3 tip_mm(random.uniform(-80, 80), random.uniform(-80, 80), random.uniform(0, 250));
    std::array<double, 3> axes{};
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 joint_mm = about_z(std::array{210, 330, 90}[i], {134.4, 0, 0});
      const double away = (tip_mm - joint_mm).head<2>().norm();
      axes[i] = from_mm(tip_mm.z() + 40 + std::sqrt(267 * 267 - away * away));
    }
    const Pose X_WT = machine.X_WB * kinematics::forward(chain, axes);
    EXPECT_LE((X_WT.translation() - from_mm(1) * tip_mm).norm(), kFar) << n;
    EXPECT_LE((tool_axis(X_WT) - Vec3::UnitZ()).norm(), kFar) << n;
  }
}

/// A row of Denavit and Hartenberg's table: Rz(theta) Tz(d) Tx(a) Rx(alpha). [mm], quarter turns
struct Row {
  double d_mm, a_mm;
  int quarters;
};
// The maker's table of the UR5.
constexpr Row kUr5[] = {{89.159, 0, 1}, {0, -425, 0},   {0, -392.25, 0},
                        {109.15, 0, 1}, {94.65, 0, -1}, {82.3, 0, 0}};

/// The tip 100 mm before the flange, seen from the arm's base; its table counts x the other way. [mm], [rad]
Tool ur5(const double* theta) {
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  for (int i = 0; i < 6; ++i) {
    const double c = std::cos(theta[i]), s = std::sin(theta[i]), ca = kUr5[i].quarters == 0 ? 1 : 0,
                 sa = kUr5[i].quarters;
    Eigen::Matrix4d A;
    A << c, -s * ca, s * sa, kUr5[i].a_mm * c,  //
        s, c * ca, -c * sa, kUr5[i].a_mm * s,   //
        0, sa, ca, kUr5[i].d_mm,                //
        0, 0, 0, 1;
    T = T * A;
  }
  const Vec3 tip = (T * Eigen::Vector4d(0, 0, 100, 1)).head<3>(), axis = -T.col(2).head<3>();
  return {{-tip.x(), -tip.y(), tip.z()}, {-axis.x(), -axis.y(), axis.z()}};
}

const Vec3 kFootMm(-450, -110, -150);

TEST(ReadyArms, OnARailMoveAsTheTableOfTheirMakerSays) {
  const MachineDescription machine = load_machine("arm-rail");
  const kinematics::Chain& chain = machine.chain().kinematics.chain;
  ASSERT_EQ(chain.size(), 7);
  Random random(62, "arm-rail");
  for (int n = 0; n < 500; ++n) {
    std::array<double, 7> axes{random.uniform(-1, 1)};
    for (std::size_t i = 1; i < axes.size(); ++i) axes[i] = random.uniform(-3, 3);
    const Tool expected = ur5(axes.data() + 1);
    const Pose X_WT = machine.X_WB * kinematics::forward(chain, axes);
    const Vec3 tip_mm = expected.tip_mm + kFootMm + Vec3(0, 1e3 * axes[0], 0);
    EXPECT_LE((X_WT.translation() - from_mm(1) * tip_mm).norm(), kFar) << n;
    EXPECT_LE((tool_axis(X_WT) - expected.axis).norm(), kFar) << n;
  }
}

TEST(ReadyArms, BesideAPositionerSeeTheirToolFromTheTable) {
  const MachineDescription machine = load_machine("arm-positioner");
  const kinematics::Chain& chain = machine.chain().kinematics.chain;
  ASSERT_EQ(chain.size(), 8);
  Random random(63, "arm-positioner");
  for (int n = 0; n < 500; ++n) {
    std::array<double, 8> axes{};
    for (double& q : axes) q = random.uniform(-3, 3);
    const Tool arm = ur5(axes.data());
    // The table tilts about x, 60 mm below its top, and turns about its own z.
    const double a = to_deg(axes[6]), c = to_deg(axes[7]);
    const auto seen = [&](const Vec3& v) {
      return about_z(-c, {v.x(), cosine(a) * v.y() + sine(a) * v.z(), -sine(a) * v.y() + cosine(a) * v.z()});
    };
    const Vec3 up(0, 0, 60), tip_mm = seen(arm.tip_mm + kFootMm + up) - up;
    const Pose X_WT = machine.X_WB * kinematics::forward(chain, axes);
    EXPECT_LE((X_WT.translation() - from_mm(1) * tip_mm).norm(), kFar) << n;
    EXPECT_LE((tool_axis(X_WT) - seen(arm.axis)).norm(), kFar) << n;
  }
}

}  // namespace
}  // namespace understudy::machine
