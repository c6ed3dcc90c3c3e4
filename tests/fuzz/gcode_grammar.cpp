#include "tests/fuzz/gcode_grammar.h"

#include <cctype>

#include <fmt/format.h>

namespace understudy::fuzz {
namespace {

using Coordinates = toolpath::RotaryWords::Coordinates;

constexpr int kLinesMax = 150;  // steps of 10 inches then stay within the largest coordinate

class Grammar {
 public:
  Grammar(std::span<const std::uint8_t> bytes, const Dialect& dialect)
      : bytes_(bytes),
        extruder_(dialect.options.extruder_letter),
        rotary_(dialect.options.rotary.has_value()),
        fixed_coordinates_(rotary_ && dialect.options.rotary->coordinates == Coordinates::crossing),
        tip_(!rotary_ || dialect.options.rotary->coordinates == Coordinates::tip) {}

  std::string run() {
    for (int line = 0; line < kLinesMax && at_ < bytes_.size(); ++line) add_line();
    line_ = "G0 X1";
    end_line();
    if (pick(2)) out_ += "M30\n; nothing but comments may follow\n";
    return std::move(out_);
  }

 private:
  int pick(int n) { return at_ < bytes_.size() ? bytes_[at_++] % n : 0; }
  double fraction() { return (256 * pick(256) + pick(256)) / 65536.0; }
  /// Within +-limit, in one of the ways that a number may be written.
  std::string number(double limit) {
    const double value = (2 * fraction() - 1) * limit;
    switch (pick(5)) {
      case 0:
        return fmt::format("{:.0f}", value);
      case 1:
        return fmt::format("{:.0f}.", value);
      case 2:
        return fmt::format("{:+.3f}", value);
      case 3:
        return fmt::format("0{:.6f}00", value < 0 ? -value : value);
      default:
        return fmt::format("{:.9f}", value);
    }
  }
  void word(char letter, const std::string& value) {
    if (!line_.empty() && pick(4) > 0) line_ += ' ';
    line_ += letter;
    line_ += value;
  }
  void word(char letter, double limit) { word(letter, number(limit)); }
  void positive(char letter, double least, double most) {
    word(letter, fmt::format("{:.4f}", least + (most - least) * fraction()));
  }

  void end_line() {
    if (pick(8) == 0) line_ = fmt::format("N{} ", pick(256)) + line_;
    // A small e behind a number of a capital word would be an exponent, so a line has one case.
    if (pick(6) == 0)
      for (char& c : line_) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    static constexpr const char* kComments[] = {"", "", "", " ; note", "(note)", "\t", " ;(", "(;)"};
    out_ += line_ + kComments[pick(8)];
    static constexpr const char* kEnds[] = {"\n", "\r\n", "\r", "\n\n"};
    out_ += kEnds[pick(4)];
    line_.clear();
  }

  void add_line() {
    switch (pick(8)) {
      case 0:
        add_process();
        break;
      case 1:
        add_without_effect();
        break;
      case 2:
        add_dwell_or_home();
        break;
      case 3:
        add_set_position();
        break;
      default:
        add_modes();
        add_move();
    }
    end_line();
  }

  void add_process() {
    switch (pick(6)) {
      case 0:
        word('M', pick(2) ? "104" : "109");
        positive('S', 0, 300);
        if (pick(2)) word('T', "1");
        break;
      case 1:
        word('M', "106");
        positive('S', 0, 255);
        break;
      case 2:
        word('M', "107");
        break;
      case 3:
        word('M', "221");
        positive('S', 1, 200);
        break;
      case 4:
        word('T', "1");
        break;
      default:
        if (inverse_time_) word('G', "94"), inverse_time_ = false;
        positive('F', 1, 9000);
        feed_ = true;
    }
  }

  void add_without_effect() {
    static constexpr const char* kLines[] = {"M17",       "M84 X Y",  "M73 P10 R5",       "M105",
                                             "M140 S60",  "M190 R50", "M201 X1000 E5000", "M862.3 P \"MK3S\"",
                                             "M900 K0.05"};
    line_ = kLines[pick(9)];
  }

  void add_dwell_or_home() {
    switch (pick(4)) {
      case 0:
        word('G', "4");
        positive('P', 0, 5000);
        break;
      case 1:
        word('G', "4");
        positive('S', 0, 10);
        break;
      case 2:
        if (!rotary_ || turns_known_) {
          line_ = pick(2) ? "G28 X" : "G28 Y0 Z";
          break;
        }
        [[fallthrough]];
      default:
        word('G', "28");
        turns_known_ = rotary_;
        shifted_ = false;
    }
  }

  void add_set_position() {
    if (!relative_ && pick(4) == 0) {
      line_ = pick(2) ? "G10 L20 P0" : "G10 L2 P1";
      word('X', 10);
      offset_ = true;
      return;
    }
    word('G', "92");
    if (pick(2)) {
      word(extruder_, 100);
      return;
    }
    word('X', 10);
    if (pick(2)) word('Z', 10);
    shifted_ = true;
    if (turns_known_ && pick(2)) word('C', 360);
  }

  void add_modes() {
    if (pick(8) == 0) word('G', pick(2) ? "20" : "21");
    if (pick(6) == 0) {
      relative_ = !relative_;
      word('G', relative_ ? "91" : "90");
    }
    if (pick(8) == 0) word('M', pick(2) ? "82" : "83");
    if (pick(8) == 0) {
      inverse_time_ = !inverse_time_;
      word('G', inverse_time_ ? "93" : "94");
      // Of G94 that was in force the feed would go on; here it changes, so it does not.
      if (inverse_time_) feed_ = false;
    }
    const bool switches = rotary_ && !fixed_coordinates_ && !shifted_ && !offset_ && turns_known_;
    if (switches && pick(8) == 0) {
      tip_ = !tip_;
      word('G', tip_ ? "43.4" : "49");
    }
  }

  void add_move() {
    if (pick(8) == 0) word('G', pick(2) ? "53" : "54");
    const bool linear = pick(3) > 0;
    word('G', linear ? "1" : "0");
    const bool extrudes = pick(2) > 0;
    if (pick(4)) word('X', 10);
    if (pick(2)) word('Y', 10);
    word('Z', 10);
    add_orientation();
    if (extrudes) word(extruder_, 50);
    const bool paced = linear || extrudes;
    if (inverse_time_) {
      if (paced) positive('F', 0.01, 1000);
    } else if (paced && (!feed_ || pick(3) == 0)) {
      positive('F', 1, 9000);
      feed_ = true;
    }
  }

  void add_orientation() {
    switch (pick(4)) {
      case 0:
        if (!tip_) return;
        add_vector(pick(2) > 0);
        turns_known_ = false;
        return;
      case 1:
        if (!rotary_) return;
        if (turns_known_) {
          word(pick(2) ? 'B' : 'C', 100);
        } else if (!relative_) {
          word('B', 100);
          word('C', 400);
          turns_known_ = true;
        }
        return;
      default:
        return;
    }
  }

  void add_vector(bool quaternion) {
    const Quat q(1 + fraction(), fraction() - 0.5, fraction() - 0.5, fraction() - 0.5);
    const Quat turn = q.normalized();
    const Vec3 axis = quaternion ? Vec3(turn.vec()) : Vec3(turn * Vec3::UnitZ());
    if (quaternion) word('W', fmt::format("{:.9f}", turn.w()));
    for (int i = 0; i < 3; ++i) word("IJK"[i], fmt::format("{:.9f}", axis[i]));
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  std::string out_, line_;
  char extruder_;
  bool rotary_, fixed_coordinates_, tip_;
  bool turns_known_ = rotary_;
  bool shifted_ = false, offset_ = false, relative_ = false, inverse_time_ = false, feed_ = false;
};

}  // namespace

std::string grammatical_program(std::span<const std::uint8_t> bytes, const Dialect& dialect) {
  return Grammar(bytes, dialect).run();
}

}  // namespace understudy::fuzz
