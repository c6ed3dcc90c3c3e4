// Which rows HAL gets, and what its samples say: the port without its processes. One thread at a time.
//
// Rows come from the project's one queue, a servo period each. Time passes as far as somebody waits for it;
// beyond, a machine that rests gets the same row again (a pause), so that its watchdog sees us alive.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/hal/hal_row.h"
#include "machine/load_reading.h"
#include "machine/setpoint_queue.h"

namespace understudy::drivers {

struct HalFeedOptions {
  std::size_t capacity = 4096;                ///< setpoints
  std::vector<kinematics::AxisRange> ranges;  ///< [m or rad], one an axis
  int lead = 200;                             ///< rows under way at most
  std::int32_t first_number = 1;              ///< of the first row
};

class HalFeed {
 public:
  /// The machine is off; `sample` is what HAL said last.
  HalFeed(const HalSettings& settings, const HalFeedOptions& options, const HalSample& sample);

  /// The next row to hand to HAL; none as long as enough are under way, or nothing may be said.
  std::optional<HalRow> next_row();
  /// In the order in which HAL gave them.
  void take(const HalSample& sample);
  /// HAL is gone, or stands still.
  void lose(const std::string& why);

  /// Rows at rest, then the reset that closes the latch. The machine is off, its drives too, and no row is
  /// under way.
  void switch_on();
  bool may_switch_on() const { return !on_ && !drives_ && seen_ == sent_ && !final_; }
  bool switching_on() const { return switching_on_; }
  /// The latch did not close: why, in words; the machine stays off with a fault.
  void give_up_switching_on();

  double now() const { return static_cast<double>(ticks_) * tick_; }
  machine::AxisState state() const;
  /// False of a machine without encoders behind the play.
  bool read_load(machine::LoadReading& reading) const;
  machine::Status submit(std::span<const machine::Setpoint> setpoints, double deadline);
  machine::Status set_outputs(const machine::Outputs& outputs, double deadline);
  machine::Status urgent(machine::UrgentCommand command);  ///< clear_fault: of a machine that is on
  void raise(machine::Fault fault, const std::string& why);
  /// A fault that no call clears.
  void stop_for_good(const std::string& why);

  /// Time may pass up to this; clipped to now by the fault that ends it.
  void wait_for(double time) { goal_ = time; }
  /// The clock shows the time or a fault stands; and where the machine is to rest, it does.
  bool arrived(double time) const;
  bool at_rest() const;
  bool on() const { return on_; }
  bool lost() const { return lost_; }
  bool final() const { return final_; }  ///< the fault is not to be cleared
  machine::Fault fault() const { return fault_; }
  const std::string& fault_text() const { return fault_text_; }
  std::uint64_t rows() const { return rows_; }
  std::uint64_t pauses() const { return pauses_; }
  std::uint64_t underruns() const { return underruns_; }

 private:
  struct Told {  ///< of a row that is under way
    double time = 0;
    std::uint64_t executed = 0;
    bool moving = false;
    machine::AxisVector position{};
  };
  machine::SetpointQueue make_queue(const machine::AxisVector& at, double now) const;
  void tick();
  bool advance();
  HalRow tell(bool reset);
  Told& told(std::int32_t number) { return told_[static_cast<std::uint32_t>(number) % told_.size()]; }
  const Told& told(std::int32_t number) const {
    return told_[static_cast<std::uint32_t>(number) % told_.size()];
  }
  void count_underruns(const HalSample& sample);
  void machine_stopped(const HalSample& sample);
  void check_in_position();
  bool caught_up() const;

  const HalSettings settings_;
  HalFeedOptions options_;
  machine::SetpointQueue queue_;
  std::vector<Told> told_;  ///< ring, by number
  machine::Outputs outputs_;
  HalSample sample_;  ///< the last one
  double tick_;       ///< [s], grain of the port's clock: that of the twin's engines
  int ticks_per_row_;
  std::int64_t ticks_ = 0;    ///< that have passed on the port's clock
  double goal_ = 0;           ///< [s], until which time may pass
  std::int32_t sent_, seen_;  ///< numbers of rows
  std::int32_t last_timed_;   ///< the one that carries what the clock's time has brought
  std::int32_t last_moving_;
  std::uint64_t accepted_before_ = 0;  ///< by queues that faults have ended
  std::uint64_t executed_before_ = 0;
  std::uint64_t executed_ = 0;  ///< that the machine has reached
  std::uint64_t rows_ = 0, pauses_ = 0, underruns_ = 0;
  int switching_pauses_ = 0;
  int samples_in_position_ = 0, samples_out_of_position_ = 0;
  bool on_ = false, drives_ = false, switching_on_ = false, lost_ = false, final_ = false;
  machine::Fault fault_ = machine::Fault::none;
  std::string fault_text_;
};

}  // namespace understudy::drivers
