// A line to a scripted controller, on a clock of its own: no time passes but in wait().
#pragma once

#include <algorithm>
#include <memory>
#include <random>
#include <string>

#include "core/error.h"
#include "drivers/gcode/byte_link.h"
#include "tests/drivers/gcode/scripted_controller.h"

namespace understudy::drivers {

/// Bytes go over it at most so many a second, in pieces of any size.
class SimulatedLink : public ByteLink {
 public:
  struct Setup {
    double bytes_per_second = 2e5;
    std::size_t piece_max = 64;  ///< of one call
    double pulled_at = 0;        ///< [s], the cable; 0: never
    std::uint64_t seed = 1;
  };
  SimulatedLink(std::shared_ptr<ScriptedController> controller, const Setup& setup)
      : controller_(std::move(controller)), setup_(setup), random_(setup.seed) {}

  double now() const override { return now_; }
  std::size_t send(std::string_view bytes) override {
    check();
    const std::size_t taken =
        std::min({bytes.size(), piece(), 4096 - std::min<std::size_t>(4096, out_.size())});
    out_ += bytes.substr(0, taken);
    return taken;
  }
  std::size_t receive(std::span<char> bytes) override {
    check();
    in_ += controller_->give();
    const std::size_t given = std::min({bytes.size(), in_.size(), piece()});
    std::copy_n(in_.begin(), given, bytes.begin());
    in_.erase(0, given);
    return given;
  }
  void wait(double until) override {
    while (now_ < until) {
      const double step = std::min(1e-3, until - now_);
      now_ += step;
      budget_ = std::min(budget_ + step * setup_.bytes_per_second, 64.0);
      const auto count = std::min(out_.size(), static_cast<std::size_t>(budget_));
      budget_ -= static_cast<double>(count);
      controller_->take(out_.substr(0, count));
      out_.erase(0, count);
      controller_->run_to(now_);
      check();
      in_ += controller_->give();
      if (!in_.empty()) return;
    }
  }

 private:
  std::size_t piece() { return std::uniform_int_distribution<std::size_t>(1, setup_.piece_max)(random_); }
  void check() const {
    if (setup_.pulled_at > 0 && now_ >= setup_.pulled_at) throw MachineError("the cable was pulled");
  }

  std::shared_ptr<ScriptedController> controller_;
  Setup setup_;
  std::mt19937_64 random_;
  double now_ = 0, budget_ = 0;
  std::string out_, in_;
};

}  // namespace understudy::drivers
