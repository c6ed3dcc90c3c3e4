#include "drivers/gcode/line_session.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "core/error.h"

namespace understudy::drivers {
namespace {

using machine::Fault;

/// Takes three bytes at a time, and gives what the test has put there.
class ShortLink : public ByteLink {
 public:
  double now() const override { return time; }
  void wait(double until) override { time = std::max(time, until); }
  std::size_t send(std::string_view bytes) override {
    if (gone) throw MachineError("the cable was pulled");
    const std::size_t taken = std::min<std::size_t>(bytes.size(), 3);
    sent += bytes.substr(0, taken);
    return taken;
  }
  std::size_t receive(std::span<char> bytes) override {
    const std::size_t given = std::min(bytes.size(), given_to_us.size());
    std::copy_n(given_to_us.begin(), given, bytes.begin());
    given_to_us.erase(0, given);
    return given;
  }

  double time = 0;
  bool gone = false;
  std::string sent, given_to_us;
};

/// Sends its lines at once; any line that comes accepts the next of them, and "done" is said of two.
class PlainSession : public LineSession {
 public:
  explicit PlainSession(ByteLink& link) : LineSession(link, {}) {}
  void connect() override {}
  void begin(const PathSample&) override {}
  void push(const Block& block) override {
    add(Role::block, "block\n", block.duration).executed = block.executed;
  }
  void push_rest(const machine::AxisVector& position) override { add(Role::rest, "").expected = position; }
  bool push_outputs(const machine::Outputs&, const machine::Outputs&) override { return false; }
  void outputs_off() override {}
  void emergency_stop() override {}
  int overdue_looks = 0;
  std::string last;
  std::size_t longest = 0;

 private:
  void handle(const std::string& line) override {
    last = line;
    longest = std::max(longest, line.size());
    if (line == "done") return confirm(2);
    if (line == "at 7") return note_position({7});
    ++accepted_;
  }
  void send_lines() override {
    for (; sent_ < entries_.size(); ++sent_) outgoing_ += entries_[sent_].text;
  }
  void watch_silence() override { ++overdue_looks; }
  std::size_t sent_ = 0;
};

Block block(double duration, std::uint64_t executed) {
  Block b;
  b.duration = duration;
  b.executed = executed;
  return b;
}

class LineSessionTest : public testing::Test {
 protected:
  void hear(const std::string& bytes) {
    link_.given_to_us += bytes;
    session_.pump();
  }
  ShortLink link_;
  PlainSession session_{link_};
};

TEST_F(LineSessionTest, WhatIsAcceptedIsNoBacklogAndNotYetExecuted) {
  session_.push(block(0.1, 3));
  session_.push(block(0.2, 8));
  session_.push_rest({});
  session_.pump();
  EXPECT_EQ(link_.sent, "block\nblock\n");
  EXPECT_DOUBLE_EQ(session_.backlog(), 0.3);
  hear("ok\r\n");
  EXPECT_DOUBLE_EQ(session_.backlog(), 0.2);
  EXPECT_EQ(session_.executed(), 0U);
  hear("ok\n\rdone\n");
  EXPECT_EQ(session_.executed(), 8U);
  EXPECT_FALSE(session_.settled()) << "the rest is not confirmed";
  hear("ok\n");
  session_.push_rest({});
  hear("ok\ndone\n");
  EXPECT_TRUE(session_.settled());
  EXPECT_EQ(session_.executed(), 8U) << "a rest counts as what is before it";
}

TEST_F(LineSessionTest, PutsPiecesTogetherAndDropsWhatNeverEnds) {
  hear("hal");
  EXPECT_EQ(session_.last, "");
  hear("f\r");
  EXPECT_EQ(session_.last, "half");
  hear(std::string(5000, 'x'));
  hear("\nnext\n");
  EXPECT_EQ(session_.last, "next");
  EXPECT_LT(session_.longest, 2000U) << "1024 bytes, and what came with the last of them";
}

TEST_F(LineSessionTest, AReportHasItsTime) {
  link_.time = 2.5;
  hear("at 7\n");
  EXPECT_EQ(session_.position()[0], 7);
  EXPECT_EQ(session_.position_time(), 2.5);
}

TEST_F(LineSessionTest, TheFirstFaultStaysAndNothingIsSentAfterIt) {
  link_.gone = true;
  session_.push(block(0.1, 1));
  session_.pump();
  EXPECT_EQ(session_.fault(), Fault::power);
  EXPECT_EQ(session_.fault_text(), "the cable was pulled");
  session_.fail(Fault::drive, "another");
  EXPECT_EQ(session_.fault(), Fault::power);
  link_.gone = false;
  const int looks = session_.overdue_looks;
  hear("ok\n");
  EXPECT_EQ(link_.sent, "");
  EXPECT_EQ(session_.last, "");
  EXPECT_EQ(session_.overdue_looks, looks);
}

}  // namespace
}  // namespace understudy::drivers
