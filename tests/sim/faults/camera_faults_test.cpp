// Each fault of the camera on a dot whose every pixel is known: a Gaussian that moves with the tool, without
// noise, so that what must and must not change is exact.
#include "sim/faults/camera_faults.h"

#include <cmath>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "sim/twin/simulated_port.h"
#include "tests/sim/faults/still_plant.h"

namespace understudy::sim {
namespace {

using testing::HasSubstr;

constexpr int kWidth = 120, kHeight = 90;
constexpr int kAmbient = 12, kPeak = 190;
constexpr double kRadius = 5;         // [px], 1 sigma
constexpr double kPxPerMetre = 64e3;  // of the tool's height
const Vec2 kDotAtZero(60, 40);        // [px]
const Region kSensor{0, 0, kWidth, kHeight};

Camera sensor() {
  Camera camera;
  camera.width = kWidth;
  camera.height = kHeight;
  return camera;
}

Vec2 dot_of(const Shot& shot) { return kDotAtZero + Vec2(kPxPerMetre * shot.X_WT.translation().z(), 0); }

/// Noise would hide what is asked: the grain of the surface is one pixel far from the dot.
Image draw(const Shot& shot) {
  const Region& r = shot.region;
  const int left = std::max(0, r.x), right = std::min(kWidth, r.x + r.width);
  Image image;
  image.region = {left, r.y, right - left, r.height};
  for (int y = 0; y < r.height; ++y)
    for (int x = left; x < right; ++x) {
      const double d2 = (Vec2(x, r.y + y) - dot_of(shot)).squaredNorm();
      const double level = kAmbient + shot.laser * kPeak * std::exp(-d2 / (2 * kRadius * kRadius));
      image.pixels.push_back(static_cast<std::uint8_t>(std::clamp(level, 0.0, 255.0)));
    }
  if (shot.surface != 0) image.pixels.front() = static_cast<std::uint8_t>(shot.surface % 251);
  return image;
}

Shot at(double height, std::uint64_t number, const Region& region = kSensor) {
  return {make_pose(Quat::Identity(), Vec3(0, 0, height)), region, number};
}

CameraFaultEvent event(CameraFaultKind kind, double time = 1) {
  CameraFaultEvent e;
  e.kind = kind;
  e.time = time;
  return e;
}

class CameraFaultTest : public testing::Test {
 protected:
  void fit(const CameraFaultEvent& e) {
    camera_ = std::make_unique<FaultyCamera>(sensor(), std::vector{e}, 7);
  }
  /// A frame at a time; the tool is higher by 0.1 mm in each.
  Image frame(double time, const Region& region = kSensor) {
    camera_->ask(time);
    last_ = at(1e-4 * number_, static_cast<std::uint64_t>(number_), region);
    ++number_;
    return camera_->expose(last_, draw);
  }
  std::unique_ptr<FaultyCamera> camera_;
  Shot last_;
  int number_ = 0;
};

TEST_F(CameraFaultTest, NothingChangesBeforeItsTime) {
  for (int k = 0; k < kCameraFaultKinds; ++k) {
    CameraFaultEvent e = event(static_cast<CameraFaultKind>(k));
    if (e.kind == CameraFaultKind::dim) e.power = 0.1;
    if (e.kind == CameraFaultKind::saturated) e.power = 4;
    if (e.kind == CameraFaultKind::displaced) e.offset_px = 8;
    fit(e);
    const Image image = frame(0.999);
    EXPECT_EQ(image.pixels, draw(last_).pixels) << to_string(e.kind);
    EXPECT_FALSE(camera_->repeats_former()) << to_string(e.kind);
    EXPECT_EQ(camera_->altered(), 0) << to_string(e.kind);
  }
}

TEST_F(CameraFaultTest, DarkIsTheAmbientLightAlone) {
  fit(event(CameraFaultKind::dark));
  for (const std::uint8_t pixel : frame(1).pixels) ASSERT_EQ(pixel, kAmbient);
  EXPECT_EQ(camera_->altered(), 1);
}

TEST_F(CameraFaultTest, DimAndSaturatedScaleTheLaserAndNotTheAmbientLight) {
  for (const auto& [kind, power] :
       {std::pair{CameraFaultKind::dim, 0.1}, std::pair{CameraFaultKind::saturated, 4.0}}) {
    CameraFaultEvent e = event(kind);
    e.power = power;
    fit(e);
    number_ = 0;
    const Image image = frame(1);
    EXPECT_EQ(image.at(60, 40), std::min(255, static_cast<int>(kAmbient + power * kPeak)));
    EXPECT_EQ(image.at(0, 0), kAmbient);
  }
}

TEST_F(CameraFaultTest, FrozenShowsTheFirstPictureWhateverRegionIsAskedFor) {
  fit(event(CameraFaultKind::frozen));
  frame(0.9);
  const Region small{50, 30, 20, 20};
  const Image first = frame(1, small);
  const Image at_strike = draw(at(1e-4, 0));
  EXPECT_EQ(first.at(5, 5), at_strike.at(55, 35));
  EXPECT_EQ(camera_->altered(), 0) << "the first one is as it should be";
  const Image later = frame(1.1);
  EXPECT_EQ(later.pixels, at_strike.pixels);
  EXPECT_NE(later.pixels, draw(last_).pixels);
  EXPECT_EQ(camera_->altered(), 1);
  EXPECT_EQ(frame(1.2, {100, 80, 40, 40}).region, (Region{100, 80, 20, 10})) << "clipped to the sensor";
}

TEST_F(CameraFaultTest, LostIsNoPicture) {
  fit(event(CameraFaultKind::lost));
  EXPECT_TRUE(frame(1).pixels.empty());
  EXPECT_EQ(camera_->altered(), 1);
}

TEST_F(CameraFaultTest, AGhostStandsStillBesideTheDotAndItsGrainChanges) {
  CameraFaultEvent e = event(CameraFaultKind::ghost);
  e.gap_offset = 50e-6;
  fit(e);
  frame(0.9);
  const Image first = frame(1), later = frame(1.1);
  const Image expected = draw(at(1e-4 + 50e-6, 0));  // 3.2 px beside where the dot was
  for (std::size_t i = 1; i < expected.pixels.size(); ++i) {
    ASSERT_EQ(first.pixels[i], expected.pixels[i]);
    ASSERT_EQ(later.pixels[i], expected.pixels[i]);
  }
  EXPECT_NE(first.pixels[0], later.pixels[0]) << "it would repeat to the last bit";
  EXPECT_EQ(camera_->altered(), 2);
}

TEST_F(CameraFaultTest, ACutBeamLacksOneSideOfEveryDotAndTheEdgeGoesWithIt) {
  CameraFaultEvent e = event(CameraFaultKind::cut_beam);
  e.offset_px = 2;
  e.direction = 0;
  fit(e);
  for (int n = 0; n < 3; ++n) {
    const Image image = frame(1 + n), whole = draw(last_);
    const int edge = static_cast<int>(std::floor(dot_of(last_).x() + 2));
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < edge; ++x) ASSERT_EQ(image.at(x, y), whole.at(x, y)) << x << ' ' << y;
      for (int x = edge + 2; x < kWidth; ++x) ASSERT_EQ(image.at(x, y), kAmbient) << x << ' ' << y;
    }
  }
  EXPECT_EQ(camera_->altered(), 3);
}

TEST_F(CameraFaultTest, AStripStandsStillAndIsAsWideAsAThread) {
  CameraFaultEvent e = event(CameraFaultKind::strip);
  e.offset_px = -10;
  fit(e);
  frame(1);  // dot at 60: hidden from 50 to 80
  const Image image = frame(2), whole = draw(last_);
  int hidden = 0;
  for (int x = 0; x < kWidth; ++x) hidden += image.at(x, 40) == kAmbient && whole.at(x, 40) > kAmbient;
  EXPECT_EQ(image.at(49, 40), whole.at(49, 40));
  EXPECT_EQ(image.at(65, 40), kAmbient);
  EXPECT_EQ(image.at(82, 40), whole.at(82, 40));
  EXPECT_GE(hidden, 20);
}

TEST_F(CameraFaultTest, ADisplacedPictureSaysWhereItWasReadOut) {
  CameraFaultEvent e = event(CameraFaultKind::displaced);
  e.offset_px = 8;
  fit(e);
  const Image image = frame(1, {40, 20, 40, 40});
  EXPECT_EQ(image.region, (Region{48, 20, 40, 40}));
  EXPECT_EQ(image.at(12, 20), draw(at(0, 0)).at(60, 40)) << "its content is what lies there";
  EXPECT_EQ(camera_->altered(), 1);
}

// Of n frames with share p the count has a standard deviation of sqrt(n p (1 - p)): 4 of them.
TEST_F(CameraFaultTest, AShareOfTheFramesIsStruck) {
  CameraFaultEvent e = event(CameraFaultKind::dark);
  e.share = 0.3;
  fit(e);
  constexpr int kFrames = 1000;
  for (int n = 0; n < kFrames; ++n) {
    number_ = 0;  // the dot stays in view
    frame(2, {50, 30, 20, 20});
  }
  EXPECT_NEAR(camera_->altered(), 0.3 * kFrames, 4 * std::sqrt(kFrames * 0.3 * 0.7));
}

TEST(CameraFaults, RefuseWhatNoCameraHas) {
  const auto refused = [](CameraFaultEvent e, const char* why) {
    try {
      check_camera_faults({e});
      ADD_FAILURE() << why;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(why));
    }
  };
  refused(event(CameraFaultKind::dark, -1), "time [s] -1 is not 0 or later");
  CameraFaultEvent e = event(CameraFaultKind::dark);
  e.share = 0;
  refused(e, "share 0 is not above 0");
  e = event(CameraFaultKind::dim);
  refused(e, "power 1 is not from 0 to below 1");
  e = event(CameraFaultKind::saturated);
  refused(e, "power 1 is not above 1");
  refused(event(CameraFaultKind::displaced), "offset [px] 0 is not 1 px or more");
  e = event(CameraFaultKind::ghost);
  e.gap_offset = 6e-3;
  refused(e, "gap offset [m] 0.006 is not within 5 mm");
}

/// Behind the port of the twin.
class FaultyFrames : public testing::Test {
 protected:
  SimulatedPort& port_with(const CameraFaultEvent& e) {
    TwinOptions options;
    options.camera_faults = {e};
    machine_ = machine::load_machine("hexapod");
    port_ = std::make_unique<SimulatedPort>(machine_, plant_, draw, std::vector<Observer*>{}, options);
    return *port_;
  }
  machine::Status capture(machine::Frame& frame) { return port_->capture(kSensor, frame, port_->now() + 1); }

  machine::MachineDescription machine_;
  StillPlant plant_;
  std::unique_ptr<SimulatedPort> port_;
};

TEST_F(FaultyFrames, AStaleFrameComesWithItsOldNumberAndTime) {
  SimulatedPort& port = port_with(event(CameraFaultKind::stale, 0.05));
  machine::Frame first, second, third;
  ASSERT_EQ(capture(first), machine::Status::ok);
  ASSERT_EQ(capture(second), machine::Status::ok);
  EXPECT_EQ(second.number, first.number + 1) << "0.03 s is before the fault";
  ASSERT_EQ(capture(third), machine::Status::ok);
  EXPECT_EQ(third.number, second.number);
  EXPECT_EQ(third.exposed_at, second.exposed_at);
  EXPECT_EQ(third.received_at, port.now());
  EXPECT_EQ(port.altered_frames(), 1);
}

TEST_F(FaultyFrames, AStaleFirstFrameIsAFreshOne) {
  port_with(event(CameraFaultKind::stale, 0));
  machine::Frame frame;
  ASSERT_EQ(capture(frame), machine::Status::ok);
  EXPECT_FALSE(frame.image.pixels.empty());
}

TEST_F(FaultyFrames, ALostFrameIsNoFrameAndTakesItsTime) {
  SimulatedPort& port = port_with(event(CameraFaultKind::lost, 0));
  machine::Frame frame;
  EXPECT_EQ(capture(frame), machine::Status::no_frame);
  EXPECT_NEAR(port.now(), machine_.microscope.exposure + machine_.microscope.transfer, 1e-9);
}

}  // namespace
}  // namespace understudy::sim
