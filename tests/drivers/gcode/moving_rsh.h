// linuxcncrsh with LinuxCNC behind it: runs the blocks that it is called for. Written from LinuxCNC's manual
// and from what linuxcncrsh 1.1 was seen to do, without anything of the driver.
#pragma once

#include <cmath>
#include <cstdlib>
#include <deque>

#include "tests/drivers/gcode/scripted_rsh.h"

namespace understudy::drivers {

/// Takes a line of MDI in a tenth of a second. After `set set_wait done` it answers the next one once all
/// motion has ended, and nothing before.
class MovingRsh : public ScriptedRsh {
 public:
  void wait(double until) override {
    while (now_ < until) {
      now_ = std::min(until, now_ + 1e-3);
      move();
      obey();
      if (!out_.empty()) return;
    }
  }

 protected:
  std::string answer(const std::string& line) override {
    if (!asked_.empty() || now_ < busy_until_ || line.starts_with("set mdi ")) {
      asked_.push_back(line);
      return "";
    }
    return at_once(line);
  }

 private:
  struct Run {
    machine::AxisVector to{};  ///< [m] and [rad], words of the pose
    double begin = 0, end = 0;
  };

  std::string at_once(const std::string& line) {
    if (line == "set set_wait done") waits_for_rest_ = true;
    if (line == "set set_wait received") waits_for_rest_ = false;
    return ScriptedRsh::answer(line);
  }
  /// The lines in their order, each in its time.
  void obey() {
    while (!asked_.empty() && now_ >= busy_until_) {
      const std::string line = asked_.front();
      if (line.starts_with("set mdi ") && !called_) {
        call(line.substr(8));
        called_ = true;
        busy_until_ = now_ + 0.1;
        return;
      }
      if (called_ && waits_for_rest_ && !runs_.empty()) return;
      called_ = false;
      asked_.pop_front();
      out_ += at_once(line);
    }
  }
  /// The arguments of one block or two are nine each: words of the pose, inverse time a minute, filament, its
  /// speed; of the feeder alone filament, speed, seconds.
  void call(const std::string& mdi) {
    std::vector<double> numbers;
    for (std::size_t at = mdi.find('['); at != std::string::npos; at = mdi.find('[', at + 1))
      numbers.push_back(std::strtod(mdi.c_str() + at + 1, nullptr));
    if (mdi.starts_with("o<understudy_move"))
      for (std::size_t first = 0; first + 9 <= numbers.size(); first += 9) {
        machine::AxisVector to{};
        for (std::size_t i = 0; i < 6; ++i)
          to[i] = i < 3 ? from_mm(numbers[first + i]) : from_deg(numbers[first + i]);
        run(to, 60 / numbers[first + 6]);
      }
    const machine::AxisVector last = runs_.empty() ? pose : runs_.back().to;
    if (mdi.starts_with("o<understudy_feed>")) run(last, numbers.at(2));
    if (mdi.starts_with("o<understudy_heat>")) run(last, 0.5);
  }
  void run(const machine::AxisVector& to, double duration) {
    const double begin = runs_.empty() ? now_ : runs_.back().end;
    if (runs_.empty()) from_ = pose;
    runs_.push_back({to, begin, begin + duration});
  }
  void move() {
    while (!runs_.empty() && now_ >= runs_.front().end) {
      from_ = pose = runs_.front().to;
      runs_.pop_front();
    }
    if (!runs_.empty()) {
      const Run& run = runs_.front();
      const double share = (now_ - run.begin) / (run.end - run.begin);
      for (std::size_t i = 0; i < 6; ++i) pose[i] = from_[i] + share * (run.to[i] - from_[i]);
    }
    joints = joints_at(pose);
  }
  /// Distances of base joints and ball joints: what genhexkins calls its joints.
  static machine::AxisVector joints_at(const machine::AxisVector& words) {
    const auto& geometry = described().hexapod().geometry;
    const Mat3 R = (Eigen::AngleAxisd(words[5], Vec3::UnitZ()) * Eigen::AngleAxisd(words[4], Vec3::UnitY()) *
                    Eigen::AngleAxisd(words[3], Vec3::UnitX()))
                       .toRotationMatrix();
    machine::AxisVector joints{};
    for (std::size_t i = 0; i < 6; ++i)
      joints[i] =
          (R * geometry.platform_joint[i] + Vec3(words[0], words[1], words[2]) - geometry.base_joint[i])
              .norm();
    return joints;
  }

  std::deque<std::string> asked_;
  std::deque<Run> runs_;
  machine::AxisVector from_{};
  double busy_until_ = 0;
  bool waits_for_rest_ = false, called_ = false;
};

}  // namespace understudy::drivers
