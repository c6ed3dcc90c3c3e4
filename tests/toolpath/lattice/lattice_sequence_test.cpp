#include "toolpath/lattice/lattice_planner.h"

#include <cmath>
#include <filesystem>
#include <numbers>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random_vector.h"
#include "core/units.h"
#include "tests/told_progress.h"
#include "tests/toolpath/lattice/arm_tool.h"
#include "toolpath/lattice/lattice_fill.h"
#include "toolpath/lattice/lattice_json.h"
#include "toolpath/program_builder.h"

namespace understudy::toolpath {
namespace {

using ::testing::HasSubstr;

using test::depth_in_tool;
using test::kDiameter;

LatticePlan plan() { return test::plan(60 * kDegree); }

Lattice standing(Lattice lattice, double scale = 1) {
  place_lattice(lattice, scale, Vec3(0, 0, 0.5 * kDiameter));
  return lattice;
}
Lattice cubes(double x, double y, double z, double strut) {
  return standing(fill_box(Vec3(x, y, z), strut).lattice);
}

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// Walks along the whole program and looks whether any point of a strut that is already printed is inside the
// tool; points that belong to a strut of the node the tip is at are the contact by design.
void expect_no_interference(const Lattice& lattice, const LatticeProgram& result) {
  std::set<int> built;
  std::size_t next = 0;
  const auto& prints = result.sequence.prints;
  const auto& steps = result.program.steps;
  for (std::size_t i = 3; i < steps.size(); ++i) {
    if (!moves(steps[i])) continue;
    const bool prints_now = steps[i].kind == StepKind::print;
    const int printing = prints_now ? prints[next].strut : -1;
    for (int k = 0; k <= 12; ++k) {
      const Pose X_TW = interpolate(steps[i - 1].X_WT, steps[i].X_WT, k / 12.0).inverse();
      for (const int s : built) {
        const Vec3 a = lattice.nodes[at(lattice.struts[at(s)][0])].position;
        const Vec3 b = lattice.nodes[at(lattice.struts[at(s)][1])].position;
        for (int j = 0; j <= 24; ++j) {
          const Vec3 p_T = X_TW * Vec3(a + (b - a) * j / 24.0);
          if (p_T.norm() < 1.1e-3) continue;
          ASSERT_LT(depth_in_tool(p_T, 0.5 * kDiameter), 1e-5)
              << "step " << i << " strut " << s << " while printing " << printing;
        }
      }
    }
    if (prints_now) {
      built.insert(printing);
      ++next;
    }
  }
  EXPECT_EQ(next, prints.size());
}

void expect_sequence(const Lattice& lattice, const StrutSequence& sequence) {
  std::vector<bool> there(lattice.nodes.size());
  for (std::size_t n = 0; n < there.size(); ++n) there[n] = lattice.nodes[n].grounded;
  std::set<int> printed;
  for (const StrutPrint& print : sequence.prints) {
    EXPECT_TRUE(printed.insert(print.strut).second) << "strut " << print.strut << " twice";
    EXPECT_EQ(std::minmax(print.from, print.to),
              std::minmax(lattice.struts[at(print.strut)][0], lattice.struts[at(print.strut)][1]));
    EXPECT_TRUE(there[at(print.from)]) << "strut " << print.strut << " begins at node " << print.from;
    there[at(print.to)] = true;
    EXPECT_NEAR(print.axis.norm(), 1, 1e-12);
  }
  EXPECT_EQ(printed.size(), lattice.struts.size());
}

// pi d^2 / 4 of strut and filament, over the way of the tip, which gaps make longer or shorter than the
// strut.
void expect_volumes(const Lattice& lattice, const LatticeProgram& result) {
  std::size_t next = 0;
  Vec3 before = Vec3::Zero();
  for (const Step& s : result.program.steps) {
    const double way = (s.X_WT.translation() - before).norm();
    before = s.X_WT.translation();
    if (s.kind != StepKind::print) {
      EXPECT_EQ(s.filament, 0);
      continue;
    }
    EXPECT_NEAR(s.filament, way * std::pow(kDiameter / 1.75e-3, 2), 1e-12);
    EXPECT_NEAR(way, lattice.length(at(result.sequence.prints[next++].strut)), kDiameter);
    EXPECT_EQ(s.feed, 1e-3);  // Ishak 2018
  }
  EXPECT_EQ(next, lattice.struts.size());
}

TEST(LatticeSequence, CubesFromFiveToElevenMillimetresArePrintedWithTheToolUpright) {
  for (const double strut : {5e-3, 8e-3, 11e-3}) {
    const Lattice lattice = cubes(3 * strut, 2 * strut, 2 * strut, strut);
    const LatticeProgram result = plan_lattice(lattice, plan());
    expect_sequence(lattice, result.sequence);
    expect_volumes(lattice, result);
    expect_no_interference(lattice, result);
    for (const StrutPrint& print : result.sequence.prints) EXPECT_NEAR(print.axis.z(), 1, 1e-12);
  }
}

TEST(LatticeSequence, PostsHigherThanTheNozzleIsLongAreTooCloseForTheHeater) {
  // Ishak 2018, figure 9: the clearance between nozzle and printed strut bounds the strut's length. Here the
  // nozzle is 12 mm long, and four posts of 14 mm stand within the reach of a heater of 11.3 mm.
  Lattice posts;
  for (const auto& [x, y] :
       {std::pair(0.0, 0.0), std::pair(6e-3, 0.0), std::pair(0.0, 6e-3), std::pair(6e-3, 6e-3)}) {
    posts.nodes.push_back({Vec3(x, y, 0.5 * kDiameter), true});
    posts.nodes.push_back({Vec3(x, y, 0.5 * kDiameter + 14e-3), false});
    const int n = static_cast<int>(posts.nodes.size());
    posts.struts.push_back({n - 2, n - 1});
  }
  LatticePlan p = plan();
  p.limits.tilt_max = 0;
  try {
    plan_lattice(posts, p);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("no tool axis within 0 deg of vertical is clear; at best the tool comes to"));
    EXPECT_THAT(error.what(), HasSubstr("the limit is 0.100 mm"));
  }
  p.limits.accept_interference = true;
  const LatticeProgram forced = plan_lattice(posts, p);
  EXPECT_FALSE(forced.sequence.warnings.empty());
  expect_sequence(posts, forced.sequence);
}

TEST(LatticeSequence, TheToolLeansAwayWhereUprightWouldRunIntoAStrut) {
  // Half-way up a post a branch rises by 45 degrees: whichever is printed last, the other stands in the cone
  // of an upright nozzle.
  Lattice fork;
  const double z = 0.5 * kDiameter;
  fork.nodes = {{Vec3(0, 0, z), true},
                {Vec3(0, 0, z + 4e-3), false},
                {Vec3(0, 0, z + 12e-3), false},
                {Vec3(8e-3, 0, z + 12e-3), false}};
  fork.struts = {{0, 1}, {1, 2}, {1, 3}};
  const LatticeProgram result = plan_lattice(fork, plan());
  expect_sequence(fork, result.sequence);
  expect_no_interference(fork, result);
  EXPECT_LT(result.sequence.prints.back().axis.z(), 1 - 1e-6);
}

TEST(LatticeSequence, WhatTheMachineCannotFollowIsRefusedWithTheStrutAndTheReason) {
  const Lattice lattice = cubes(10e-3, 10e-3, 5e-3, 5e-3);
  LatticePlan p = plan();
  p.limits.way = [](const std::vector<Pose>&, bool) { return "axis 2 is at its end"; };
  try {
    plan_lattice(lattice, p);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("strut 0 from "));
    EXPECT_THAT(error.what(),
                HasSubstr("no tool axis within 60 deg of vertical can print it: axis 2 is at its end"));
  }
}

TEST(LatticeSequence, TheMachineIsAskedForTheWholeWay) {
  // Upright above what is built, in, along the strut, out, and back up: as the program drives it.
  Lattice fork;
  const double z = 0.5 * kDiameter;
  fork.nodes = {{Vec3(0, 0, z), true}, {Vec3(0, 0, z + 4e-3), false}, {Vec3(8e-3, 0, z + 12e-3), false}};
  fork.struts = {{0, 1}, {1, 2}};
  std::vector<std::vector<Pose>> asked;
  LatticePlan p = plan();
  p.limits.way = [&](const std::vector<Pose>& way, bool fine) {
    EXPECT_NEAR(tool_axis(way.front()).z(), 1, 1e-12);
    if (fine) asked.push_back(way);
    return "";
  };
  const LatticeProgram result = plan_lattice(fork, p);
  for (const StrutPrint& print : result.sequence.prints) {
    const bool whole = std::any_of(asked.begin(), asked.end(), [&](const std::vector<Pose>& way) {
      bool along = false;
      for (std::size_t i = 1; i < way.size(); ++i)
        along = along || (way[i - 1].translation().isApprox(print.tip_from, 1e-9) &&
                          way[i].translation().isApprox(print.tip_to, 1e-9));
      return along && way.back().translation().z() > 2e-3 + z + 4e-3;
    });
    EXPECT_TRUE(whole) << print.strut;
  }
}

// A post goes on upwards from a node at which an arm rises by this angle. The tool stays upright: the post
// comes last, with the nozzle's flat on the node.
std::string answer_of_arm(double elevation_deg, double joint_press) {
  const double z = 0.5 * kDiameter, e = elevation_deg * kDegree;
  Lattice fork;
  const Vec3 node(0, 0, z + 5e-3);
  fork.nodes = {{Vec3(0, 0, z), true},
                {node, false},
                {node + 8e-3 * Vec3(std::cos(e), 0, std::sin(e)), false},
                {node + Vec3(0, 0, 6e-3), false}};
  fork.struts = {{0, 1}, {1, 2}, {1, 3}};
  LatticePlan p = plan();
  p.limits.tilt_max = 0;
  p.limits.joint_press = joint_press;
  try {
    plan_lattice(fork, p);
  } catch (const InputError& error) {
    return error.what();
  }
  return "planned";
}

TEST(LatticeSequence, AtAJointTheNozzlePressesInNoDeeperThanTheRehearsalAllows) {
  // The flat's rim is 0.5 mm from the node and half a strut above it. The arm's middle line passes below at
  // 0.24 cos(e) - 0.5 sin(e); 0.1 mm less a quarter of the margin of 0.1 mm may be pressed in, so 0.165 mm
  // must be left: e = 8.33 degrees.
  EXPECT_EQ(answer_of_arm(8.1, 0.1e-3), "planned");
  EXPECT_THAT(answer_of_arm(8.5, 0.1e-3), HasSubstr("is clear; at best the tool comes to -0.0"));
  EXPECT_THAT(answer_of_arm(8.5, 0.1e-3), HasSubstr("the limit is -0.075 mm"));
  // With 0.2 mm: 0.24 cos(e) - 0.5 sin(e) = 0.065, e = 18.9 degrees.
  EXPECT_EQ(answer_of_arm(18.7, 0.2e-3), "planned");
  EXPECT_THAT(answer_of_arm(19.1, 0.2e-3), HasSubstr("is clear"));
}

// As above, but the tool may lean away from the arm: the flat of an upright one would press 0.07 mm into it.
TEST(LatticeSequence, WhereAnotherAxisPressesLessAtAJointThatOneIsTaken) {
  const double z = 0.5 * kDiameter, e = 8.1 * kDegree;
  Lattice fork;
  const Vec3 node(0, 0, z + 5e-3), along(std::cos(e), 0, std::sin(e));
  fork.nodes = {
      {Vec3(0, 0, z), true}, {node, false}, {node + 8e-3 * along, false}, {node + Vec3(0, 0, 6e-3), false}};
  fork.struts = {{0, 1}, {1, 2}, {1, 3}};
  for (const StrutPrint& print : plan_lattice(fork, plan()).sequence.prints) {
    if (print.strut != 2) continue;
    // Distance of the arm's middle line to the nozzle's flat and, within 2 %, to the cone above it.
    const Pose X_TW = tool_at(print.tip_from, print.axis).inverse(Eigen::Isometry);
    double nearest = 1;
    for (double l = 0; l < 8e-3; l += 10e-6) {
      const Vec3 p_T = X_TW * (node + l * along);
      const double rho = p_T.head<2>().norm(), beyond = rho - 0.5e-3 - 0.25 * std::max(0.0, p_T.z());
      nearest = std::min(nearest, p_T.z() < 0 ? std::hypot(std::max(0.0, beyond), p_T.z()) : 0.97 * beyond);
    }
    // Half of 0.1 mm, less a quarter of the margin.
    EXPECT_GE(nearest, 0.5 * kDiameter - 0.025e-3) << print.axis.transpose();
  }
}

// A bar between two posts: from the post that was printed last it goes on as it is; to the other one, that
// stands, the tip comes as near as to the table.
TEST(LatticeSequence, ToWhatStandsTheTipKeepsTheGap) {
  const double z = 0.5 * kDiameter;
  Lattice gate;
  gate.nodes = {{Vec3(0, 0, z), true},
                {Vec3(8e-3, 0, z), true},
                {Vec3(0, 0, z + 6e-3), false},
                {Vec3(8e-3, 0, z + 6e-3), false}};
  gate.struts = {{0, 2}, {1, 3}, {2, 3}};
  std::vector<double> tips;
  for (const Step& s : plan_lattice(gate, plan()).program.steps)
    if (s.kind == StepKind::print) tips.push_back(s.X_WT.translation().z());
  ASSERT_EQ(tips.size(), 3u);
  EXPECT_NEAR(tips[0], z + 6e-3 + 0.24e-3, 1e-12) << "nothing is there";
  EXPECT_NEAR(tips[1], z + 6e-3 + 0.24e-3, 1e-12) << "nothing is there";
  EXPECT_NEAR(tips[2], z + 6e-3 + 0.24e-3 + 0.13e-3, 1e-12) << "a post stands there";
}

TEST(LatticeSequence, StrutsOnTheTableMayMeetAndCross) {
  // A cross of two flat struts, and a frame around it: all nodes grounded.
  Lattice flat;
  const double z = 0.5 * kDiameter, w = 10e-3;
  for (const auto& [x, y] : {std::pair(0.0, 0.0), std::pair(w, 0.0), std::pair(w, w), std::pair(0.0, w)})
    flat.nodes.push_back({Vec3(x, y, z), true});
  flat.struts = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 2}, {1, 3}};
  LatticePlan p = plan();
  p.limits.tilt_max = 0;
  const LatticeProgram result = plan_lattice(flat, p);
  expect_sequence(flat, result.sequence);
  for (const StrutPrint& print : result.sequence.prints) EXPECT_NEAR(print.tip_to.z(), 0.13e-3, 1e-12);
}

TEST(LatticeSequence, TheSameFrameGivesTheSameOrder) {
  const Lattice lattice = cubes(16e-3, 16e-3, 16e-3, 8e-3);
  const auto order = [&] {
    std::vector<int> struts;
    for (const StrutPrint& print : plan_lattice(lattice, plan()).sequence.prints)
      struts.push_back(print.strut);
    return struts;
  };
  EXPECT_EQ(order(), order());
}

TEST(LatticeSequence, DwellsAtEveryNodeAndLeavesOnlyWhereItMust) {
  const Lattice lattice = cubes(15e-3, 5e-3, 5e-3, 5e-3);
  const LatticeProgram result = plan_lattice(lattice, plan());
  int dwells = 0, approaches = 0;
  for (const Step& s : result.program.steps) {
    dwells += s.kind == StepKind::dwell && s.duration == 3;
    approaches += s.kind == StepKind::move;
  }
  EXPECT_EQ(dwells, static_cast<int>(lattice.struts.size()));
  EXPECT_LT(approaches, static_cast<int>(lattice.struts.size()));
}

TEST(LatticeSequence, RandomFramesKeepEveryRule) {
  Random random(20180801, "frames");
  int printed = 0;
  for (int trial = 0; trial < 8; ++trial) {
    // Part of a cubic lattice with its nodes moved about and some struts taken out.
    Lattice lattice = cubes(16e-3, 16e-3, 16e-3, 8e-3);
    for (LatticeNode& n : lattice.nodes) {
      const double z = n.position.z();
      n.position += 1e-3 * uniform_vec3(random, 1);
      if (n.grounded) n.position.z() = z;
    }
    for (int k = 0; k < 14; ++k) {
      Lattice less = lattice;
      const auto which =
          static_cast<std::ptrdiff_t>(random.uniform(0, 1) * static_cast<double>(less.struts.size() - 1));
      less.struts.erase(less.struts.begin() + which);
      if (hanging_nodes(less).empty()) lattice = less;
    }
    SCOPED_TRACE("trial " + std::to_string(trial));
    try {
      const LatticeProgram result = plan_lattice(lattice, plan());
      expect_sequence(lattice, result.sequence);
      expect_volumes(lattice, result);
      expect_no_interference(lattice, result);
      ++printed;
    } catch (const InputError&) {
      // Some frames have a strut that no axis is clear for; that is an answer too.
    }
  }
  EXPECT_GE(printed, 4);
}

TEST(LatticeSequence, FramesOfOthersArePlanned) {
  const std::filesystem::path folder = UNDERSTUDY_SOURCE_DIR "/../shared/data/lattices";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder;
  const Lattice four = standing(read_lattice(folder / "four-frame.json"));
  const LatticeProgram result = plan_lattice(four, plan());
  expect_sequence(four, result.sequence);
  expect_no_interference(four, result);
}

TEST(LatticeSequence, EveryValueIsChecked) {
  const Lattice lattice = cubes(5e-3, 5e-3, 5e-3, 5e-3);
  const auto rejection = [](const Lattice& l, const LatticePlan& p) -> std::string {
    try {
      plan_lattice(l, p);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  ASSERT_EQ(rejection(lattice, plan()), "accepted");
  for (double LatticePlan::*field : {&LatticePlan::feed, &LatticePlan::approach_feed, &LatticePlan::approach,
                                     &LatticePlan::filament_diameter})
    for (const double bad : {0.0, -1.0, std::nan("")}) {
      LatticePlan p = plan();
      p.*field = bad;
      EXPECT_THAT(rejection(lattice, p), HasSubstr("must be above 0"));
    }
  for (double SequenceLimits::*field :
       {&SequenceLimits::strut_diameter, &SequenceLimits::nozzle_flat, &SequenceLimits::ground_gap,
        &SequenceLimits::margin, &SequenceLimits::joint, &SequenceLimits::lift})
    for (const double bad : {0.0, -1.0, std::nan("")}) {
      LatticePlan p = plan();
      p.limits.*field = bad;
      EXPECT_THAT(rejection(lattice, p), HasSubstr("must be above 0"));
    }
  LatticePlan p = plan();
  p.limits.tilt_max = 91 * kDegree;
  EXPECT_THAT(rejection(lattice, p), HasSubstr("largest tilt is 91 deg"));
  p = plan();
  p.dwell = -1;
  EXPECT_THAT(rejection(lattice, p), HasSubstr("dwell is -1 s"));
  EXPECT_THAT(rejection(Lattice{}, plan()), HasSubstr("the lattice has 0 struts"));
  Lattice sunk = lattice;
  sunk.nodes[0].position.z() = 0;
  EXPECT_THAT(rejection(sunk, plan()), HasSubstr("lower than half a strut above the table, 0.240 mm"));
  Lattice hanging = lattice;
  for (LatticeNode& n : hanging.nodes) n.grounded = false;
  EXPECT_THAT(rejection(hanging, plan()), HasSubstr("not connected to a grounded node"));
}

TEST(LatticeSequence, TellsHowFarTheSearchIs) {
  const Lattice lattice = cubes(15e-3, 10e-3, 10e-3, 5e-3);
  understudy::test::ToldProgress told;
  LatticePlan told_plan = plan();
  told_plan.limits.progress = told.teller();
  plan_lattice(lattice, told_plan);
  EXPECT_EQ(told.stages(), (std::set<std::string>{"looking at each strut alone", "finding an order",
                                                  "leaving room at joints"}));
  told.expect_even(0.05);  // each strut, in each of four passes
}

}  // namespace
}  // namespace understudy::toolpath
