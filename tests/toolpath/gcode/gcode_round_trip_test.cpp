// What is written reads back the same, and no bytes whatever crash the reader.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/random_vector.h"
#include "core/units.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::toolpath {
namespace {

const GcodeOptions kOptions{make_pose(Quat(0.8, 0, 0.6, 0), Vec3(0.01, -0.02, 0.05))};

Quat random_turn(Random& random) {
  return Quat(random.normal(), random.normal(), random.normal(), random.normal()).normalized();
}

Program random_program(std::uint64_t seed) {
  Random random(seed, "program");
  Program program;
  Pose at = kOptions.X_WT_home;
  const auto pick = [&](int n) { return static_cast<int>(random.uniform() * n); };
  for (int n = 1 + pick(60); n >= 0; --n) {
    Step step;
    step.kind = n == 0 ? StepKind::travel : static_cast<StepKind>(pick(7));  // all but end
    if (step.kind == StepKind::home) at = kOptions.X_WT_home;
    if (step.kind == StepKind::travel || step.kind == StepKind::move || step.kind == StepKind::print) {
      if (pick(4) > 0) at.translation() = normal_vec3(random) * 0.1;
      if (pick(3) > 0) at.linear() = random_turn(random).toRotationMatrix();
    }
    step.X_WT = at;
    // Filament well above the printed 1e-6 mm, so that a print stays a print.
    if (step.kind == StepKind::print) step.filament = random.uniform(1e-7, 1e-2);
    if (step.kind == StepKind::move && pick(3) == 0) step.filament = -random.uniform(1e-7, 1e-2);
    if (step.kind == StepKind::move || step.kind == StepKind::print)
      (step.filament != 0 || pick(3) == 0 ? step.duration : step.feed) =
          random.uniform(1e-3, 10) * (pick(2) ? 1 : 0.1);
    if (step.kind == StepKind::dwell) step.duration = random.uniform(0, 100);
    if (step.kind == StepKind::temperature) {
      step.temperature = random.uniform(273.15, 600);
      step.wait = pick(2) == 0;
    }
    if (step.kind == StepKind::fan) step.fan = pick(3) == 0 ? 0 : random.uniform();
    program.steps.push_back(step);
  }
  return program;
}

void expect_same(const Program& read, const Program& written) {
  ASSERT_EQ(read.steps.size(), written.steps.size());
  for (std::size_t i = 0; i < read.steps.size(); ++i) {
    const Step &r = read.steps[i], &w = written.steps[i];
    ASSERT_EQ(r.kind, w.kind) << i;
    const double lengths = 0.51e-9;  // [m], half of the last printed digit, 1e-6 mm, and rounding
    ASSERT_LT((r.X_WT.translation() - w.X_WT.translation()).cwiseAbs().maxCoeff(), lengths) << i;
    // 0.5e-9 in each of four components of half the angle.
    ASSERT_LT(angle_between(r.X_WT.linear(), w.X_WT.linear()), 2.1e-9) << i;
    ASSERT_NEAR(r.filament, w.filament, 2 * lengths) << i;  // difference of two readings
    ASSERT_NEAR(r.feed, w.feed, 0.51e-6 * kMillimetrePerMinute) << i;
    ASSERT_NEAR(r.duration, w.duration, 1e-9 * (1 + w.duration)) << i;  // 12 decimals of 60 / s, or 1e-6 ms
    ASSERT_NEAR(r.temperature, w.temperature, 0.51e-6) << i;
    ASSERT_EQ(r.wait, w.wait) << i;
    ASSERT_NEAR(r.fan, w.fan, 0.51e-6 / 255) << i;
  }
}

TEST(GcodeRoundTrip, WritingAndReadingGivesTheSameProgramWithinThePrintedDigits) {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Program written = random_program(seed);
    const std::string text = write_gcode(written, {"made by a test", "two\nlines"});
    const Program read = parse_gcode(text, "round", kOptions);
    expect_same(read, written);
    if (HasFatalFailure()) return;
  }
}

TEST(GcodeRoundTrip, WritingWhatWasReadSettlesOnOneText) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const std::string once =
        write_gcode(parse_gcode(write_gcode(random_program(seed), {}), "a", kOptions), {});
    EXPECT_EQ(once.find('e'), std::string::npos);  // no exponents
    expect_same(parse_gcode(once, "b", kOptions),
                parse_gcode(write_gcode(random_program(seed), {}), "a", kOptions));
  }
}

TEST(GcodeWriter, RefusesWhatGcodeCannotSay) {
  Program program;
  program.steps.emplace_back();
  program.steps[0].kind = StepKind::print;
  EXPECT_THROW(write_gcode(program, {}), InputError);  // no feed
  program.steps[0].feed = std::numeric_limits<double>::infinity();
  EXPECT_THROW(write_gcode(program, {}), InputError);
  program.steps[0].feed = 1e-3;
  EXPECT_NO_THROW(write_gcode(program, {}));
  program.steps[0].X_WT.translation().x() = std::nan("");
  EXPECT_THROW(write_gcode(program, {}), InputError);
}

std::string damaged(std::string text, Random& random) {
  static const std::string kLikely = "GMXYZEFWIJKPSN0123456789.-+ ;()\n\rnaif%";
  for (int n = 1 + static_cast<int>(random.uniform() * 5); n > 0 && !text.empty(); --n) {
    const auto at = static_cast<std::size_t>(random.uniform() * static_cast<double>(text.size()));
    const char c =
        random.uniform() < 0.7
            ? kLikely[static_cast<std::size_t>(random.uniform() * static_cast<double>(kLikely.size()))]
            : static_cast<char>(random.bits());
    switch (static_cast<int>(random.uniform() * 5)) {
      case 0:
        text[at] = c;
        break;
      case 1:
        text.insert(at, 1, c);
        break;
      case 2:
        text.erase(at, 1 + static_cast<std::size_t>(random.uniform() * 8));
        break;
      case 3:
        text.insert(at,
                    text.substr(static_cast<std::size_t>(random.uniform() * static_cast<double>(at)), 20));
        break;
      default:
        text.resize(at);
    }
  }
  return text;
}

void expect_program_or_error(const std::string& text) {
  try {
    const Program program = parse_gcode(text, "fuzz", kOptions);
    for (const Step& step : program.steps) {
      ASSERT_TRUE(step.X_WT.matrix().allFinite()) << text;
      ASSERT_NEAR(step.X_WT.linear().determinant(), 1, 1e-9) << text;
      ASSERT_TRUE(std::isfinite(step.feed) && std::isfinite(step.duration) && std::isfinite(step.filament))
          << text;
      ASSERT_TRUE(step.feed >= 0 && step.duration >= 0) << text;
    }
  } catch (const InputError& error) {
    ASSERT_EQ(std::string(error.what()).find('\n'), std::string::npos) << text;
    ASSERT_EQ(error.place().file, "fuzz") << text;
  }
}

TEST(GcodeFuzz, RandomBytesGiveAnError) {
  Random random(31, "bytes");
  for (int i = 0; i < 3000; ++i) {
    std::string text;
    for (int n = static_cast<int>(random.uniform() * 200); n > 0; --n)
      text += static_cast<char>(random.bits());
    expect_program_or_error(text);
    if (HasFatalFailure()) return;
  }
}

TEST(GcodeFuzz, DamagedProgramsGiveAProgramOrAnError) {
  Random random(32, "damage");
  for (int i = 0; i < 6000; ++i) {
    expect_program_or_error(
        damaged(write_gcode(random_program(static_cast<std::uint64_t>(i % 40)), {"x"}), random));
    if (HasFatalFailure()) return;
  }
}

}  // namespace
}  // namespace understudy::toolpath
