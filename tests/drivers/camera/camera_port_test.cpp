#include "drivers/camera/camera_port.h"

#include <deque>

#include <gtest/gtest.h>

#include "machine/loopback_port.h"

namespace understudy::drivers {
namespace {

using machine::Status;

TimedImage picture(double exposed_at, std::uint64_t number) {
  TimedImage image;
  image.image.region = {0, 0, 4, 3};
  for (std::uint8_t i = 0; i < 12; ++i) image.image.pixels.push_back(i);
  image.exposed_at = exposed_at;
  image.number = number;
  return image;
}

/// Delivers what a test has put into it, each when its time has come.
struct Scripted : FrameSource {
  std::deque<TimedImage> frames;
  std::string why;
  std::optional<TimedImage> newest() override {
    std::optional<TimedImage> newest;
    while (!frames.empty() && frames.front().exposed_at <= wall_clock()) {
      newest = frames.front();
      frames.pop_front();
    }
    return newest;
  }
  std::string ended() const override { return why; }
};

class CameraPortTest : public testing::Test {
 protected:
  machine::LoopbackPort machine_{machine::LoopbackPort::Options{}};
  Scripted* camera_ = new Scripted;
  CameraPort port_{machine_, std::unique_ptr<FrameSource>(camera_)};
  machine::Frame frame_;
};

TEST_F(CameraPortTest, ReturnsTheFirstFrameExposedAfterTheCallAndNoOlderOne) {
  const double now = wall_clock();
  camera_->frames = {picture(now - 0.5, 7), picture(now - 0.001, 8), picture(now + 0.05, 9)};
  ASSERT_EQ(port_.capture({0, 0, 4, 3}, frame_, port_.now() + 1), Status::ok);
  EXPECT_EQ(frame_.number, 9U);
  EXPECT_GE(frame_.exposed_at, 0);
  EXPECT_LE(frame_.exposed_at, frame_.received_at);
  EXPECT_LT(frame_.received_at - frame_.exposed_at, 0.05);  // it was there a look or two after its exposure
  EXPECT_GT(port_.now(), 0.03);                             // the machine's time passed meanwhile
}

TEST_F(CameraPortTest, CutsTheRegionOutOfTheSensor) {
  camera_->frames = {picture(wall_clock() + 0.01, 0)};
  ASSERT_EQ(port_.capture({2, 1, 9, 9}, frame_, port_.now() + 1), Status::ok);
  EXPECT_EQ(frame_.image.region, (Region{2, 1, 2, 2}));
  EXPECT_EQ(frame_.image.pixels, (std::vector<std::uint8_t>{6, 7, 10, 11}));
}

TEST_F(CameraPortTest, AStaleCameraRunsIntoTheDeadlineAndAnEndedOneDeliversNothing) {
  camera_->frames = {picture(wall_clock() - 1, 0)};
  EXPECT_EQ(port_.capture({0, 0, 4, 3}, frame_, port_.now() + 0.05), Status::deadline_exceeded);
  EXPECT_EQ(port_.capture({0, 0, 4, 3}, frame_, port_.now() - 0.01), Status::deadline_exceeded);
  camera_->why = "unplugged";
  EXPECT_EQ(port_.capture({0, 0, 4, 3}, frame_, port_.now() + 60), Status::no_frame);
  EXPECT_EQ(port_.use().used, 0U);
}

TEST_F(CameraPortTest, CountsExposuresThatAreMissingBetweenStamps) {
  // One every 20 ms; of 0 to 6 the exposures 3 and 4 never came. Numbers count what was delivered.
  const double begin = wall_clock() + 0.02;
  std::uint64_t number = 0;
  for (const int exposure : {0, 1, 2, 5, 6})
    camera_->frames.push_back(picture(begin + 0.02 * exposure, number++));
  while (port_.use().used < 5 && port_.capture({0, 0, 4, 3}, frame_, port_.now() + 1) == Status::ok) {
  }
  EXPECT_EQ(port_.use().used, 5U);
  EXPECT_EQ(port_.use().dropped, 2U);
}

}  // namespace
}  // namespace understudy::drivers
