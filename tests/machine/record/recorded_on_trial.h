// A port that is recorded, for the suite of port_conformance.h: it keeps all promises.
#pragma once

#include "machine/loopback_port.h"
#include "machine/record/recording_port.h"
#include "tests/machine/port_conformance.h"
#include "tests/temporary_folder.h"

namespace understudy::machine {

class RecordedOnTrial : public PortOnTrial {
 public:
  RecordedOnTrial()
      : port_(options(), [this](const auto& state, const Region& region, Image& image) {
          return look(state, region, image);
        }) {
    range = options().ranges[0];
    capacity = 2000;
    clock_step = 0.5e-3;  // while it brakes, as the loopback port; exact otherwise
  }
  MachinePort& port() override { return recorded_; }
  void lose_frames(bool lost) override { lost_ = lost; }

 private:
  static LoopbackPort::Options options() {
    LoopbackPort::Options options;
    options.queue_capacity = 2000;
    options.ranges.assign(6, {-0.1, 0.1});
    return options;
  }
  bool look(const AxisState& /*state*/, const Region& region, Image& image) const {
    image.region = region;
    image.pixels.assign(static_cast<std::size_t>(region.width * region.height), 7);
    return !lost_;
  }
  bool lost_ = false;
  TemporaryFolder folder_;
  LoopbackPort port_;
  RecordWriter writer_{folder_ / "a.record", 6};
  RecordingPort recorded_{port_, writer_};
};

}  // namespace understudy::machine
