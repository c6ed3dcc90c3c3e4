// Random sessions with controllers and lines that misbehave: what the port calls done has been done, every
// block of it once and in order, and no session outlasts its deadline.
#include <cmath>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/drivers/gcode/gcode_trial.h"

namespace understudy::drivers {
namespace {

using machine::Setpoint;
using machine::Status;

constexpr double kNever = 1e9;
constexpr int kMotions = 2;
/// [s], for half a second of motion, whatever goes wrong: a second of silence, twice asked into, for each of
/// some lost lines.
constexpr double kDeadline = 12;

struct Session {
  Firmware firmware = Firmware::grblhal;
  Mischief mischief;
  SimulatedLink::Setup line;
  std::uint64_t seed = 0;
};

double uniform(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<>(low, high)(random);
}

/// Motions between rests: corners, pauses, filament.
std::vector<Setpoint> motion(std::mt19937_64& random, const Setpoint& from) {
  std::vector<Setpoint> path;
  const auto count = std::uniform_int_distribution<>(150, 500)(random);
  const double w = uniform(random, 0.5, 4), feed = uniform(random, 0, 0.01);
  std::array<double, 6> span{};
  for (double& s : span) s = uniform(random, -3e-3, 3e-3);
  for (int n = 1; n <= count; ++n) {
    const double share = static_cast<double>(n) / count, s = share * share * (3 - 2 * share);
    const double ds = 6 * share * (1 - share) / (count * 1e-3);
    Setpoint p = from;
    p.time = from.time + n * 1e-3;
    p.filament = from.filament + feed * s;
    for (std::size_t i = 0; i < 6; ++i) {
      p.position[i] = from.position[i] + span[i] * std::sin(w * s);
      p.velocity[i] = span[i] * w * std::cos(w * s) * ds;
    }
    if (n == count) p.velocity = {};
    path.push_back(p);
  }
  return path;
}

std::vector<std::string> words_of(const ScriptedController& controller) {
  std::vector<std::string> words;
  for (const auto& block : controller.ran()) words.push_back(block.words);
  return words;
}

struct Result {
  bool good = false;  ///< the port calls everything done
  std::vector<std::string> ran;
  std::string fault;
};

Result run(const Session& session) {
  std::mt19937_64 random(session.seed);
  Result result;
  GcodeTrial trial;
  try {
    trial = make_trial(session.firmware, session.mischief, session.line, "&reply_s=1&boot_s=3");
  } catch (const MachineError& error) {
    result.fault = error.what();
    return result;
  }
  GcodePort& port = *trial.port;
  Setpoint last;
  last.position = port.state().position;
  Status answer = Status::ok;
  for (int part = 0; part < kMotions && answer == Status::ok; ++part) {
    last.time = part * kDeadline;  // the same in every session: blocks are equal to the last digit
    const auto path = motion(random, last);
    if (port.submit(path, kNever) != Status::ok) break;
    last = path.back();
    answer = port.wait_until((part + 1) * kDeadline);
    if (port.state().executed < port.state().accepted) break;
  }
  result.good = answer == Status::ok && port.state().executed == port.state().accepted;
  result.fault = port.fault_text();
  result.ran = words_of(*trial.controller);
  return result;
}

/// RepRapFirmware does not count numbers: a line whose answer is lost runs again, to where it led already.
std::vector<std::string> without_repeats(const std::vector<std::string>& words) {
  std::vector<std::string> once;
  for (const std::string& word : words)
    if (once.empty() || once.back() != word) once.push_back(word);
  return once;
}

Session session_of(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Session session;
  session.seed = seed;
  session.firmware = static_cast<Firmware>(std::uniform_int_distribution<>(0, 2)(random));
  Mischief& m = session.mischief;
  m.seed = session.line.seed = seed;
  const auto sometimes = [&](double most) {
    return uniform(random, 0, 1) < 0.4 ? uniform(random, 0, most) : 0;
  };
  m.reply_delay = sometimes(0.03);
  m.garbage = sometimes(0.1);
  m.stray_ok = sometimes(0.03);
  if (session.firmware == Firmware::marlin) {
    m.lost_ok = sometimes(0.01);
    m.corrupt = sometimes(0.02);
    m.lost_line = sometimes(0.01);
    m.needless_resend = sometimes(0.02);
  }
  if (session.firmware == Firmware::reprapfirmware) {
    m.stray_ok = 0;
    m.lost_ok = sometimes(0.01);
    m.corrupt = sometimes(0.02);
    m.needless_resend = sometimes(0.02);
  }
  session.line.bytes_per_second = uniform(random, 0, 1) < 0.3 ? 11520 : 2e5;
  session.line.piece_max = std::uniform_int_distribution<std::size_t>(1, 64)(random);
  const double when = uniform(random, 0.2, 3);
  switch (std::uniform_int_distribution<>(0, 11)(random)) {
    case 0:
      m.reset_at = when;
      break;
    case 1:
      m.silent_at = when;
      break;
    case 2:
      m.alarm_at = when;
      break;
    case 3:
      m.error_at = when;
      break;
    case 4:
      session.line.pulled_at = when;
      break;
    default:
      break;
  }
  return session;
}

struct Tally {
  int good = 0, faulted = 0;
};

/// The first that differ.
std::string difference(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  const auto at = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
  if (at.first == a.end() && at.second == b.end()) return "";
  return "block " + std::to_string(at.first - a.begin()) + ": " +
         (at.first == a.end() ? "nothing" : *at.first) + " in place of " +
         (at.second == b.end() ? "nothing" : *at.second);
}

void expect_nothing_lost(std::uint64_t seed, Tally& tally) {
  const Session session = session_of(seed);
  const Result result = run(session);
  if (!result.good) {
    ASSERT_FALSE(result.fault.empty()) << "seed " << seed << ": neither done nor a reason";
    ++tally.faulted;
    return;
  }
  ++tally.good;
  Session calm = session;
  calm.mischief = {};
  calm.line = {};
  const Result expected = run(calm);
  ASSERT_TRUE(expected.good) << "seed " << seed << ": " << expected.fault;
  if (session.firmware == Firmware::reprapfirmware)
    ASSERT_EQ(difference(without_repeats(result.ran), without_repeats(expected.ran)), "") << "seed " << seed;
  else
    ASSERT_EQ(difference(result.ran, expected.ran), "") << "seed " << seed;
}

void expect_nothing_lost_in(std::uint64_t first, int count) {
  Tally tally;
  for (int i = 0; i < count; ++i)
    ASSERT_NO_FATAL_FAILURE(expect_nothing_lost(first + static_cast<std::uint64_t>(i), tally));
  // Neither outcome is rare: most accidents end a session, and most others do not.
  EXPECT_GT(tally.good, count / 3);
  EXPECT_GT(tally.faulted, count / 10);
  testing::Test::RecordProperty("good", tally.good);
  testing::Test::RecordProperty("faulted", tally.faulted);
}

TEST(MisbehavingSessions, ALineThatIsLostInTheBufferOfTheControllerIsAFault) {
  // An `ok` too many, after which a second line did not fit into the 128 bytes: its end was lost.
  Tally tally;
  expect_nothing_lost(10053, tally);
  EXPECT_EQ(tally.faulted, 1);
}

TEST(MisbehavingSessions, NoBlockIsLostRepeatedOrReordered) { expect_nothing_lost_in(1, 300); }

TEST(SlowMisbehavingSessions, NoBlockIsLostRepeatedOrReorderedInTenThousand) {
  expect_nothing_lost_in(1000, 10000);
}

}  // namespace
}  // namespace understudy::drivers
