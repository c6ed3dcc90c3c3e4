// Approaches under every fault that a picture or a machine can have, by the thousand: none touches, and each
// that stops says why.
#include <cmath>
#include <map>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "core/units.h"
#include "tests/control/gap/gap_stage.h"

namespace understudy::control {
namespace {

enum class Trouble {
  none,
  dark,
  saturated,
  frozen,
  stale,
  lost,
  ghost,
  cut,
  dim,
  offset_picture,
  gives_way,
  count
};

/// Strikes below a height, in every frame or in some.
struct Fault {
  Trouble trouble = Trouble::none;
  double below = 0;  ///< [m], above S
  double share = 1;  ///< of the frames
};

Fault draw_fault(Random& random) {
  Fault fault;
  fault.trouble =
      static_cast<Trouble>(static_cast<int>(random.uniform(0, static_cast<double>(Trouble::count))));
  fault.below = random.uniform(0.02e-3, 2.5e-3);
  fault.share = random.uniform() < 0.5 ? 1 : random.uniform(0.1, 1);
  return fault;
}

/// An edge that hides a part of every dot, at up to one and a half of its radii from the centre.
struct Cut {
  Vec2 side{1, 0};
  Vec2 offset{0, 0};
};

Cut draw_cut(Random& random) {
  const double turn = random.uniform(0, 2 * std::numbers::pi);
  Cut cut{{std::cos(turn), std::sin(turn)}, {0, 0}};
  cut.offset = random.uniform(-4, 8) * cut.side;
  return cut;
}

void cause(const Fault& fault, const Start& start, Stage& stage, Random& random) {
  if (fault.trouble == Trouble::gives_way) {
    const double jump = random.uniform(-0.1e-3, 0.1e-3);  // all play of the struts at once
    stage.rig().set_play([&stage, fault, start, jump](const Pose& X) -> Vec3 {
      return stage.height(X) < fault.below ? Vec3(jump * tool_axis(start.X_WT_S)) : Vec3(Vec3::Zero());
    });
    return;
  }
  const auto frozen = std::make_shared<std::optional<Vec2>>();
  const Vec2 ghost(random.uniform(40, 600), random.uniform(40, 440));
  const Cut cut = draw_cut(random);
  stage.rig().set_frame_fault(
      [&stage, &random, fault, start, frozen, ghost, cut](const Pose& X, Image& image) {
        if (stage.height(X) > fault.below || random.uniform() > fault.share) return true;
        const auto dot = exact_dot(hexapod(), start.world, stage.rig().truth(X));
        switch (fault.trouble) {
          case Trouble::dark:
            std::fill(image.pixels.begin(), image.pixels.end(), std::uint8_t{12});
            return true;
          case Trouble::saturated:
            for (auto& p : image.pixels) p = p > 30 ? 255 : p;
            return true;
          case Trouble::frozen:
            if (!*frozen) *frozen = dot;
            if (*frozen) stage.rig().draw_spot(**frozen, 190, image);
            return true;
          case Trouble::stale:
            stage.rig().port().repeat_frames(fault.share < 1 ? 1 + static_cast<int>(random.uniform(0, 4))
                                                             : kForGood);
            return true;
          case Trouble::lost:
            return false;
          case Trouble::ghost:
            stage.rig().draw_spot(ghost, 190, image);
            return true;
          case Trouble::cut:
            if (dot) hide_beyond(*dot + cut.offset, cut.side, image);
            return true;
          case Trouble::dim:
            if (dot) stage.rig().draw_spot(*dot, 8, image);
            return true;
          case Trouble::offset_picture:
            image.region.x += 8;
            return true;
          default:
            return true;
        }
      });
}

void approach_with_faults(int first, int approaches) {
  std::map<std::string, int> stops;
  int touched = 0, reached = 0;
  for (int i = first; i < first + approaches; ++i) {
    Random random(static_cast<std::uint64_t>(i), "faulted approaches");
    const double degrees = random.uniform(-20, 20);
    const Start start = i % 2 ? on_bottle(degrees) : on_slope(degrees);
    const double error = random.uniform(-1e-3, 1e-3);
    Stage stage(start, error, Vec3::Zero(), Vec3::Zero(), static_cast<std::uint64_t>(i));
    const Fault fault = draw_fault(random);
    cause(fault, start, stage, random);
    const GapOutcome outcome = stage.run();
    if (!(stage.way().gap_min > 0)) {
      ++touched;
      ADD_FAILURE() << "approach " << i << ", trouble " << static_cast<int>(fault.trouble) << " below "
                    << fault.below << " in " << fault.share << " of the frames touches: " << outcome.why;
    }
    if (outcome.stop == GapStop::none) {
      ++reached;
      continue;
    }
    ++stops[to_string(outcome.stop)];
    EXPECT_FALSE(outcome.why.empty()) << "approach " << i;
    EXPECT_NE(outcome.why.find("retreated by"), std::string::npos) << "approach " << i << ": " << outcome.why;
  }
  EXPECT_EQ(touched, 0);
  // The draw is not toothless: a good part stops, and for many reasons; the rest gets there.
  EXPECT_GT(reached, approaches / 10);
  EXPECT_GT(approaches - reached, approaches / 4);
  EXPECT_GE(stops.size(), 5u);
  std::string counted = "reached " + std::to_string(reached);
  for (const auto& [reason, count] : stops) counted += ", " + reason + " " + std::to_string(count);
  std::printf("%d faulted approaches: %s\n", approaches, counted.c_str());
}

TEST(FaultedApproach, NoneOfSixtyTouchesAndEachStopSaysWhy) { approach_with_faults(900, 60); }
TEST(SlowFaultedApproach, NoneOfTenThousandTouchesAndEachStopSaysWhy) { approach_with_faults(0, 10'000); }

}  // namespace
}  // namespace understudy::control
