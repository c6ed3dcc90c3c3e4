// A controller that reads G-code, byte by byte, on a clock that the test turns: written from the manuals of
// the families, without anything of the driver. It can misbehave in every way that lines and firmwares have.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace understudy::drivers {

enum class Firmware { grblhal, marlin, reprapfirmware };

/// Shares are of lines or replies, from 0 to 1; times in [s], above 0 where it happens.
struct Mischief {
  double reply_delay = 0;      ///< [s], at most, of each reply
  double garbage = 0;          ///< a line of noise before a reply
  double stray_ok = 0;         ///< one `ok` more
  double lost_ok = 0;          ///< one less
  double corrupt = 0;          ///< one byte of a line arrives as another
  double lost_line = 0;        ///< a line does not arrive
  double needless_resend = 0;  ///< the line is asked for again though it was right
  double reset_at = 0, silent_at = 0, alarm_at = 0, error_at = 0;
  std::uint64_t seed = 1;
};

class ScriptedController {
 public:
  struct Setup {
    Firmware firmware = Firmware::grblhal;
    std::string letters = "XYZABC";  ///< of the axes, in the order of its reports
    char extruder = 'U';
    std::array<double, 8> start{};  ///< [mm or deg]
    std::size_t planner = 16;       ///< blocks
    std::size_t receive_buffer = 128;
    double step = 0;  ///< [mm or deg], positions are reported on
  };
  /// Of a G1 or a G4 that ran.
  struct Ran {
    std::string words;          ///< without number and sum
    double begin = 0, end = 0;  ///< [s]
    std::array<double, 8> from{}, to{};
    double fed_from = 0, fed_to = 0;  ///< [mm]
  };

  ScriptedController(Setup setup, const Mischief& mischief);

  void take(std::string_view bytes);  ///< from the host
  std::string give();                 ///< to the host, what is due
  void run_to(double time);           ///< [s]

  const std::vector<Ran>& ran() const { return ran_; }
  bool dead() const { return dead_; }  ///< reset, silent or in alarm
  double temperature() const { return temperature_; }

 private:
  struct Late {
    double due = 0;
    std::string text;
  };
  bool numbers() const { return setup_.firmware != Firmware::grblhal; }
  bool happens(double share) { return share > 0 && std::uniform_real_distribution<>(0, 1)(random_) < share; }
  void boot();
  void say(const std::string& line);
  void ok();
  void realtime(char c);
  void read_line();
  void numbered(std::string line);
  void refuse(const std::string& why);
  void obey(const std::string& words);
  void motion(const std::string& words);
  void status();
  std::array<double, 8> where() const;
  std::string coordinates(const char* separator, int decimals, bool letters) const;
  void end_of_block();
  void accidents();
  double duration_of(const std::array<double, 8>& to, double fed_to, double feed) const;

  Setup setup_;
  Mischief mischief_;
  std::mt19937_64 random_;
  double now_ = 0;
  std::string received_;
  std::deque<Late> late_;
  std::deque<Ran> planner_;
  std::array<double, 8> planned_{};
  double planned_fed_ = 0;
  bool running_ = false, inverse_ = false, dead_ = false, mute_ = false;
  double busy_until_ = 0;  ///< of the interpreter
  std::string waiting_;    ///< M400, G4, M109 that is not answered yet
  int last_number_ = 0, line_of_block_ = 0;
  std::deque<int> block_numbers_;
  std::vector<Ran> ran_;
  double temperature_ = 0;
};

}  // namespace understudy::drivers
