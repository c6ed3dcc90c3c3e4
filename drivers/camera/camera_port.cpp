#include "drivers/camera/camera_port.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "core/cut_image.h"

namespace understudy::drivers {

using machine::Status;

namespace {

constexpr double kBetween = 2e-3;  // [s], two looks for a frame

}  // namespace

double wall_clock() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

void CameraPort::watch_stamps(const TimedImage& image) {
  if (seen_ && image.number > last_number_) {
    const double step = image.exposed_at - last_stamp_;
    const auto delivered = image.number - last_number_;
    const double each = step / static_cast<double>(delivered);
    interval_ = interval_ == 0 ? each : std::min(interval_, each);
    const double exposures = interval_ > 0 ? std::round(step / interval_) : 0;
    if (exposures > static_cast<double>(delivered))
      use_.dropped += static_cast<std::uint64_t>(exposures) - delivered;
  }
  seen_ = true;
  last_stamp_ = image.exposed_at;
  last_number_ = image.number;
}

Status CameraPort::capture(const Region& region, machine::Frame& frame, double deadline) {
  if (port_.now() > deadline) return Status::deadline_exceeded;
  const double asked_at = wall_clock();
  while (true) {
    if (const auto image = source_->newest()) {
      watch_stamps(*image);
      if (image->exposed_at >= asked_at) {
        const double age = std::max(0.0, wall_clock() - image->exposed_at);
        frame.image = cut(image->image, region);
        frame.received_at = port_.now();
        frame.exposed_at = frame.received_at - age;
        frame.number = image->number;
        ++use_.used;
        use_.oldest = std::max(use_.oldest, age);
        return Status::ok;
      }
    } else if (!source_->ended().empty()) {
      return Status::no_frame;
    }
    if (port_.now() >= deadline) return Status::deadline_exceeded;
    const double began = wall_clock();
    const Status passed = port_.wait_until(std::min(deadline, port_.now() + kBetween));
    if (passed != Status::ok) return passed;
    // A simulated clock does not wait for the camera.
    const double rest = kBetween - (wall_clock() - began);
    if (rest > 0) std::this_thread::sleep_for(std::chrono::duration<double>(rest));
  }
}

}  // namespace understudy::drivers
