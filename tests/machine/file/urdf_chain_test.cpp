#include "machine/file/urdf_chain.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "core/random_vector.h"
#include "kinematics/chain/chain.h"
#include "machine/file/urdf_writer.h"
#include "tests/temporary_folder.h"

namespace understudy::machine {
namespace {

namespace fs = std::filesystem;
using kinematics::Chain;
using kinematics::ChainAxis;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const fs::path kShipped = UNDERSTUDY_SOURCE_DIR "/models/offset-wrist-arm/arm.urdf";

class UrdfFile : public testing::Test {
 protected:
  fs::path write(const std::string& text) {
    const fs::path path = folder_ / "arm.urdf";
    std::ofstream(path) << text;
    return path;
  }
  /// A robot of the links base, arm and tool with these joints.
  std::string complaint(const std::string& body, const std::string& base = "base",
                        const std::string& tool = "tool") {
    return complaint_of(
        "<robot name='r'><link name='base'/><link name='arm'/><link name='tool'/>" + body + "</robot>", base,
        tool);
  }
  std::string complaint_of(const std::string& text, const std::string& base = "base",
                           const std::string& tool = "tool") {
    const fs::path path = write(text);
    testing::internal::CaptureStderr();
    testing::internal::CaptureStdout();
    std::string message = "nothing thrown";
    try {
      read_urdf(path, base, tool);
    } catch (const InputError& e) {
      message = e.what();
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_THAT(message, HasSubstr(path.string())) << message;
    return message;
  }

  const TemporaryFolder folder_;
};

std::string joint(const std::string& name, const std::string& type, const std::string& parent,
                  const std::string& child, const std::string& inside) {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent + "'/><child link='" +
         child + "'/>" + inside + "</joint>";
}
const std::string kLimit = "<limit lower='-1' upper='1' effort='2' velocity='3'/>";
const std::string kAxis = "<axis xyz='0 0 1'/>";
const std::string kGood = joint("a", "revolute", "base", "arm", kAxis + kLimit) +
                          joint("b", "prismatic", "arm", "tool", kAxis + kLimit);

Mat3 turn(double angle, const Vec3& axis) { return Eigen::AngleAxisd(angle, axis).toRotationMatrix(); }
Pose shift(double x, double y, double z) { return make_pose(Mat3(Mat3::Identity()), Vec3(x, y, z)); }

// Link by link, with the numbers of the file typed again; rounding of a dozen products.
TEST(UrdfChain, TheShippedArmMovesAsItsJointsSay) {
  const UrdfArm arm = read_urdf(kShipped, "base", "tool");
  ASSERT_EQ(arm.chain.size(), 6);
  Random random(1, "urdf");
  const auto turned = [](double q, const Vec3& axis) { return make_pose(turn(q, axis), Vec3(0, 0, 0)); };
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  for (int n = 0; n < 200; ++n) {
    std::array<double, 6> q{};
    for (double& v : q) v = random.uniform(-3, 3);
    const Pose expected = shift(0, 0, 0.15) * turned(q[0], z) * shift(0, 0.125, 0) * turned(q[1], y) *
                          shift(0.38, -0.11, 0) * turned(q[2], y) * shift(0.34, 0, 0) * turned(q[3], y) *
                          shift(0, 0.105, 0) * turned(q[4], -z) * shift(0, 0, -0.09) * turned(q[5], y) *
                          shift(0, 0.085, 0) * turned(-std::numbers::pi / 2, x) * shift(0, 0, 0.095) *
                          turned(std::numbers::pi, x);
    EXPECT_LE((forward(arm.chain, q).matrix() - expected.matrix()).cwiseAbs().maxCoeff(), 1e-14);
  }
}

TEST(UrdfChain, TheShippedArmKeepsItsRangesDrivesAndMasses) {
  const UrdfArm arm = read_urdf(kShipped, "base", "tool");
  EXPECT_EQ(arm.chain.axes[2].name, "j3");
  EXPECT_EQ(arm.chain.axes[2].lower, -2.8);
  EXPECT_EQ(arm.chain.axes[5].upper, 6.283185307179586);
  ASSERT_EQ(arm.drives.size(), 6u);
  EXPECT_EQ(arm.drives[0].effort_max, 150);
  EXPECT_EQ(arm.drives[5].velocity_max, 3.14);
  double mass = 0;
  for (const LinkMass& link : arm.links) mass += link.mass;
  EXPECT_NEAR(mass, 3.6 + 3.4 + 6.8 + 2.3 + 1.2 + 1.2 + 0.25 + 0.45, 1e-12);
  EXPECT_EQ(arm.links.front().axis, -1);
  const auto tool =
      std::find_if(arm.links.begin(), arm.links.end(), [](const LinkMass& l) { return l.name == "tool"; });
  ASSERT_NE(tool, arm.links.end());
  EXPECT_EQ(tool->axis, 5);
  // At zero the tip is at (0.72, 0.30, 0.06) and z of T along -y: 50 mm back is y = 0.25.
  EXPECT_LE((tool->centre_O - Vec3(0.72, 0.25, 0.06)).norm(), 1e-14);
  EXPECT_NEAR(tool->inertia_O(1, 1), 0.0003, 1e-16);  // about z of T
}

// The numeric inverse serves an arm that has no spherical wrist.
TEST(UrdfChain, TheShippedArmReachesPosesByTheNumericInverse) {
  const UrdfArm arm = read_urdf(kShipped, "base", "tool");
  kinematics::ChainDescription d;
  d.kind = "chain";
  d.chain = arm.chain;
  d.home = {0, -1.2, 1.7, -2.1, -1.5, 0};
  const auto machine = make_chain_mechanism(d);
  Random random(2, "urdf inverse");
  for (int n = 0; n < 300; ++n) {
    std::array<double, 6> q{}, found{};
    for (double& v : q) v = random.uniform(-2.7, 2.7);
    const Pose X = forward(d.chain, q);
    ASSERT_EQ(machine->inverse(X, {}, found), kinematics::SolveStatus::ok);
    const Pose reached = forward(d.chain, found);
    EXPECT_LE((reached.translation() - X.translation()).norm(), 1e-11);
    EXPECT_LE(angle_between(reached.linear(), X.linear()), 1e-11);
  }
}

TEST_F(UrdfFile, FixedContinuousAndPrismaticJointsAreUnderstood) {
  const fs::path path =
      write("<robot name='r'><link name='world'/><link name='base'/><link name='arm'/><link name='tool'/>" +
            joint("w", "fixed", "world", "base", "<origin xyz='1 2 3'/>") +
            joint("a", "continuous", "base", "arm", "<axis xyz='0 3 4'/>") +
            joint("b", "prismatic", "arm", "tool",
                  "<origin xyz='0.1 0 0' rpy='0 0 1'/><axis xyz='1 0 0'/>" + kLimit) +
            "</robot>");
  const UrdfArm arm = read_urdf(path, "base", "tool");
  ASSERT_EQ(arm.chain.size(), 2);
  EXPECT_EQ(arm.chain.axes[0].upper, kinematics::kEndless);
  EXPECT_EQ(arm.drives[0].velocity_max, kinematics::kEndless);
  EXPECT_LE((arm.chain.axes[0].direction - Vec3(0, 0.6, 0.8)).norm(), 1e-15);
  EXPECT_FALSE(arm.chain.axes[1].angle);
  const std::array<double, 2> q{0.4, 0.5};
  const Pose expected = make_pose(turn(0.4, Vec3(0, 0.6, 0.8)), Vec3(0, 0, 0)) * shift(0.1, 0, 0) *
                        make_pose(turn(1, Vec3::UnitZ()), Vec3(0, 0, 0)) * shift(0.5, 0, 0);
  EXPECT_LE((forward(arm.chain, q).matrix() - expected.matrix()).cwiseAbs().maxCoeff(), 1e-14);
}

TEST_F(UrdfFile, AJointBesideTheWayIsHeldAndItsMassCarried) {
  const fs::path path = write(
      "<robot name='r'><link name='base'/><link name='arm'/><link name='tool'/><link name='finger'>"
      "<inertial><mass value='2'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' "
      "izz='1'/></inertial></link>" +
      kGood + joint("f", "revolute", "arm", "finger", "<origin xyz='0 0.5 0'/>" + kAxis + kLimit) +
      "</robot>");
  const UrdfArm arm = read_urdf(path, "base", "tool");
  ASSERT_EQ(arm.chain.size(), 2);
  ASSERT_EQ(arm.links.size(), 1u);
  EXPECT_EQ(arm.links[0].axis, 0);
  EXPECT_LE((arm.links[0].centre_O - Vec3(0, 0.5, 0)).norm(), 1e-15);
}

TEST_F(UrdfFile, WhatIsNotSupportedIsNamed) {
  const auto first = [&](const std::string& type, const std::string& inside) {
    return complaint(joint("a", type, "base", "arm", inside) + joint("b", "fixed", "arm", "tool", ""));
  };
  EXPECT_THAT(first("planar", kAxis), HasSubstr("joint 'a' has the type planar: not supported"));
  EXPECT_THAT(first("floating", ""), HasSubstr("joint 'a' has the type floating: not supported"));
  EXPECT_THAT(first("revolute", kAxis + kLimit + "<mimic joint='z'/>"), HasSubstr("joint 'a' mimics 'z'"));
  EXPECT_THAT(first("fixed", ""), HasSubstr("no joint moves 'tool' against 'base'"));
  EXPECT_THAT(first("screwy", kAxis), AllOf(HasSubstr("[a]"), HasSubstr("screwy")));
}

TEST_F(UrdfFile, BadNumbersAreNamed) {
  const auto first = [&](const std::string& inside) {
    return complaint(joint("a", "revolute", "base", "arm", inside) + joint("b", "fixed", "arm", "tool", ""));
  };
  EXPECT_THAT(first("<axis xyz='0 0 0'/>" + kLimit),
              HasSubstr("joint 'a': axis xyz is 0 0 0, which has no direction"));
  EXPECT_THAT(first(kAxis + "<limit lower='1' upper='-1' effort='1' velocity='1'/>"),
              HasSubstr("joint 'a': limit lower 1 is not below upper -1"));
  EXPECT_THAT(first(kAxis), HasSubstr("joint 'a' is revolute and has no limit"));
  EXPECT_THAT(first(kAxis + "<limit lower='-1' upper='1' effort='-1' velocity='1'/>"),
              HasSubstr("effort -1"));
  for (const char* bad : {"nan", "inf", "-inf", "1e999", "ten"}) {
    EXPECT_THAT(first("<origin xyz='0 " + std::string(bad) + " 0'/>" + kAxis + kLimit),
                AllOf(HasSubstr(bad), HasSubstr("[a]")));
    EXPECT_THAT(first("<axis xyz='0 0 " + std::string(bad) + "'/>" + kLimit),
                AllOf(HasSubstr(bad), HasSubstr("[a]")));
    EXPECT_THAT(first(kAxis + "<limit lower='-1' upper='" + bad + "' effort='1' velocity='1'/>"),
                AllOf(HasSubstr(bad), Not(HasSubstr("nothing thrown"))));
  }
}

TEST_F(UrdfFile, BodiesThatCannotBeAreNamed) {
  const auto with = [&](const std::string& mass, const std::string& izz) {
    return complaint(
        kGood + joint("c", "fixed", "tool", "extra", "") + "<link name='extra'><inertial><mass value='" +
        mass + "'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='" + izz + "'/></inertial></link>");
  };
  EXPECT_THAT(with("-2", "1"), HasSubstr("link 'extra': mass is -2 kg, must not be negative"));
  EXPECT_THAT(with("2", "3"),
              HasSubstr("link 'extra': no body has the inertia of principal moments 1, 1, 3"));
  EXPECT_THAT(with("2", "-1"), HasSubstr("link 'extra': no body has the inertia"));
  EXPECT_THAT(with("nan", "1"), HasSubstr("mass [nan] is not a float"));
  EXPECT_THAT(with("1e300", "1"), HasSubstr("link 'extra': mass is 1e+300 kg, more than 10000"));
  EXPECT_THAT(with("1", "1e300"), HasSubstr("more than 1000000"));
}

TEST_F(UrdfFile, BrokenTreesAreNamed) {
  EXPECT_THAT(complaint(kGood + joint("c", "fixed", "base", "tool", "")),
              HasSubstr("link 'tool' is the child of two joints, 'b' and 'c'"));
  EXPECT_THAT(complaint(kGood + joint("c", "fixed", "tool", "base", "")), HasSubstr("root link"));
  EXPECT_THAT(complaint(kGood, "base", "toll"), HasSubstr("has no link 'toll', did you mean 'tool'?"));
  EXPECT_THAT(complaint(kGood, "floor", "tool"), HasSubstr("has no link 'floor'"));
  EXPECT_THAT(complaint(joint("a", "revolute", "base", "nowhere", kAxis + kLimit)), HasSubstr("nowhere"));
  EXPECT_THAT(complaint(kGood + "<link name='tool'/>"), HasSubstr("not unique"));
  EXPECT_THAT(complaint_of("<robot"), HasSubstr("is no URDF"));
  EXPECT_THAT(complaint_of(""), HasSubstr("is no URDF"));
  EXPECT_THAT(complaint_of("<machine/>"), HasSubstr("is no URDF"));
  EXPECT_THAT(complaint_of(std::string("\0\xff\x80<", 4)), HasSubstr("is no URDF"));
  EXPECT_THROW(read_urdf(folder_ / "missing.urdf", "base", "tool"), InputError);
}

// urdfdom takes each of these; a walk through them would not end, or overflow the stack.
TEST_F(UrdfFile, LoopsIslandsAndDepthsAreRefused) {
  const std::string round =
      joint("c", "fixed", "arm2", "tool2", "") + joint("d", "fixed", "tool2", "arm2", "");
  EXPECT_THAT(complaint("<link name='arm2'/><link name='tool2'/>" + kGood + round, "base", "tool2"),
              HasSubstr("is not connected to the root link"));
  std::string links, deep;
  for (int i = 0; i < 1001; ++i) links += "<link name='l" + std::to_string(i) + "'/>";
  EXPECT_THAT(complaint(kGood + links), HasSubstr("links, more than 1000"));
  for (int i = 0; i < 100'000; ++i) deep += "<a>";
  EXPECT_THAT(complaint_of("<robot>" + deep), HasSubstr("nested more than 100 deep"));
}

// A name becomes a column of CSV and a key of YAML; a mass, a quotient of forces.
TEST_F(UrdfFile, NamesAndMassesThatOthersCannotReadAreRefused) {
  const auto named = [&](const std::string& name) {
    return complaint(joint(name, "revolute", "base", "arm", kAxis + kLimit) +
                     joint("b", "prismatic", "arm", "tool", kAxis + kLimit));
  };
  for (const char* name : {"a&#10;b", "a, b", "a: b", "a}", "&quot;a", "a#b", "\xc3\xa4"})
    EXPECT_THAT(named(name), HasSubstr("letters, digits, spaces and - _ . / are allowed")) << name;
  EXPECT_THAT(named(std::string(101, 'a')), HasSubstr("100 characters or fewer"));
  const auto of = [&](const std::string& mass, const std::string& moment) {
    return complaint_of(
        "<robot name='r'><link name='base'/><link name='arm'/><link name='tool'><inertial><mass value='" +
            mass + "'/><inertia ixx='" + moment + "' iyy='" + moment + "' izz='" + moment +
            "' ixy='0' ixz='0' iyz='0'/></inertial></link>" + kGood + "</robot>",
        "base", "tool");
  };
  EXPECT_THAT(of("1e300", "1"), HasSubstr("mass is 1e+300 kg, more than 10000"));
  EXPECT_THAT(of("1", "1e300"), HasSubstr("inertia holds 1e+300 kg m^2, more than 1000000"));
}

TEST_F(UrdfFile, MoreAxesThanAMachineHasAreRefused) {
  std::string links, joints;
  for (int i = 0; i < 9; ++i) {
    links += "<link name='l" + std::to_string(i) + "'/>";
    joints += joint("j" + std::to_string(i), "continuous", i ? "l" + std::to_string(i - 1) : "base",
                    "l" + std::to_string(i), kAxis);
  }
  EXPECT_THAT(complaint_of("<robot name='r'><link name='base'/>" + links + joints + "</robot>", "base", "l8"),
              HasSubstr("joint 'j8' is axis 9"));
}

Vec3 random_vector(Random& random, double size) { return uniform_vec3(random, size); }

/// Axes of both kinds under tool and work.
Chain random_chain(Random& random) {
  Chain chain;
  for (int i = 0; i < 6; ++i) {
    ChainAxis axis;
    axis.name = "a" + std::to_string(i);
    axis.angle = random.uniform() < 0.6;
    axis.direction = random_vector(random, 1).normalized();
    axis.point = random_vector(random, 0.5);
    if (i % 2 || !axis.angle) axis.lower = -2, axis.upper = 2;
    int& end = i % 3 == 1 ? chain.work_axis : chain.tool_axis;
    axis.parent = end;
    end = i;
    chain.axes.push_back(axis);
  }
  // Every other one with a pitch of exactly a right angle, where roll and yaw are not told apart.
  const Mat3 upright = turn(std::numbers::pi / 2, Vec3::UnitY());
  chain.X_OT_zero =
      make_pose(random.uniform() < 0.5 ? Mat3(turn(random.uniform(-3, 3), Vec3::UnitX()) * upright)
                                       : exp_rotation(random_vector(random, 2)),
                random_vector(random, 0.5));
  chain.X_OS_zero = make_pose(exp_rotation(random_vector(random, 2)), random_vector(random, 0.5));
  return chain;
}

TEST_F(UrdfFile, WrittenAndReadAgainAChainMovesTheSame) {
  Random random(3, "urdf round trip");
  for (int n = 0; n < 60; ++n) {
    const Chain chain = random_chain(random);
    const UrdfArm again = read_urdf(write(write_urdf("a <\"&> name", chain)), "work", "tool");
    ASSERT_EQ(again.chain.size(), chain.size());
    std::array<double, 6> q{}, q_again{};
    for (std::size_t i = 0; i < 6; ++i) q[i] = random.uniform(-2, 2);
    for (std::size_t i = 0; i < 6; ++i) {  // axes of the tool come first
      const auto k = static_cast<std::size_t>(again.chain.axes[i].name[1] - '0');
      q_again[i] = q[k];
      EXPECT_EQ(again.chain.axes[i].angle, chain.axes[k].angle);
      EXPECT_EQ(again.chain.axes[i].lower, chain.axes[k].lower);
      EXPECT_EQ(again.chain.axes[i].upper, chain.axes[k].upper);
    }
    const Pose before = forward(chain, q), after = forward(again.chain, q_again);
    // 17 digits in the file, angles of roll and pitch by urdfdom's quaternions: far below 1e-9.
    EXPECT_LE((before.matrix() - after.matrix()).cwiseAbs().maxCoeff(), 1e-13);
  }
}

TEST_F(UrdfFile, NamesOfAxesAreEscaped) {
  Random random(4, "urdf names");
  Chain chain = random_chain(random);
  chain.axes[2].name = "R&D \"x\"><link name='x'/>";
  const fs::path path = write(write_urdf("arm", chain));
  try {  // such a name is refused; that the refusal has all of it shows that it was one attribute
    read_urdf(path, "work", "tool");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("joint '" + chain.axes[2].name + "'"));
  }
}

// Mass, first moment and inertia about the tip of all that an axis carries are what they were.
TEST_F(UrdfFile, WrittenAndReadAgainTheBodiesWeighTheSame) {
  const UrdfArm arm = read_urdf(kShipped, "base", "tool");
  const UrdfArm again = read_urdf(write(write_urdf("arm", arm.chain, arm.links, arm.drives)), "work", "tool");
  for (int axis = -1; axis < 6; ++axis) {
    const auto moments = [&](const UrdfArm& a) {
      double mass = 0;
      Vec3 first = Vec3::Zero();
      Mat3 second = Mat3::Zero();
      for (const LinkMass& l : a.links) {
        if (l.axis != axis) continue;
        mass += l.mass;
        first += l.mass * l.centre_O;
        second += l.inertia_O + l.mass * (l.centre_O.squaredNorm() * Mat3::Identity() -
                                          l.centre_O * l.centre_O.transpose());
      }
      Eigen::Matrix<double, 13, 1> all;
      all << mass, first, Eigen::Map<Eigen::Matrix<double, 9, 1>>(second.data());
      return all;
    };
    EXPECT_LE((moments(arm) - moments(again)).cwiseAbs().maxCoeff(), 1e-14) << "axis " << axis;
  }
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(again.drives[i].velocity_max, arm.drives[i].velocity_max);
    EXPECT_EQ(again.drives[i].effort_max, arm.drives[i].effort_max);
  }
}

}  // namespace
}  // namespace understudy::machine
