#include "drivers/gcode/post_port.h"

#include <cmath>
#include <functional>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "machine/description.h"
#include "tests/drivers/gcode/path_distance.h"

namespace understudy::drivers {
namespace {

using machine::Setpoint;

/// A block as a controller reads it: where it ends, and how long it takes by its feed.
struct Read {
  std::map<char, double> at;
  double duration = 0;
};

/// G1 lines behind the one that goes to the start; G94 as RS274/NGC 2.1.2.5 counts feeds.
std::vector<Read> read_back(const std::vector<std::string>& lines, bool inverse) {
  std::vector<Read> blocks;
  std::map<char, double> at;
  bool started = false;
  for (const std::string& line : lines) {
    if (!line.starts_with("G1 ") && !line.starts_with("G4 ")) continue;
    std::map<char, double> words, before = at;
    for (std::size_t i = 0; i < line.size(); ++i)
      if (line[i] >= 'A' && line[i] <= 'Z') words[line[i]] = std::strtod(line.c_str() + i + 1, nullptr);
    double duration = 0;
    if (line[1] == '4') {
      duration = words['P'] * (inverse ? 1 : 1e-3);
    } else {
      const double feed = words['F'];
      words.erase('F');
      words.erase('G');
      for (const auto& [letter, value] : words) at[letter] = value;
      if (inverse) duration = 60 / feed;
      for (const char* group : {"XYZ", "UVW", "ABC", "E"}) {
        if (duration > 0) break;
        double square = 0;
        for (const char* c = group; *c != '\0'; ++c)
          if (at.contains(*c)) square += std::pow(at[*c] - before[*c], 2);
        if (square > 0) duration = 60 * std::sqrt(square) / feed;
      }
    }
    if (started) blocks.push_back({at, duration});  // the first names every axis
    started = true;
  }
  return blocks;
}

/// Half a turn of all axes, with filament, from where the machine stands.
std::vector<Setpoint> path_from(const machine::AxisVector& start, int axes) {
  std::vector<Setpoint> path;
  for (int n = 1; n <= 2000; ++n) {
    Setpoint s;
    const double share = n / 2000.0, u = share * share * (3 - 2 * share);
    s.time = n * 1e-3;
    s.filament = 5e-3 * u;
    for (int i = 0; i < axes; ++i) {
      const auto axis = static_cast<std::size_t>(i);
      const double span = 3e-3 + 1e-3 * i, w = 2 + 0.5 * i;
      s.position[axis] = start[axis] + span * std::sin(w * u);
      s.velocity[axis] = span * w * std::cos(w * u) * 6 * share * (1 - share) / 2;
    }
    if (n == 2000) s.velocity = {};
    path.push_back(s);
  }
  return path;
}

class PostedFor : public testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(PostedFor, ReadsBackAsTheSamePath) {
  const auto machine = machine::load_machine(GetParam().second);
  const auto mechanism = machine.make_mechanism();
  machine::AxisVector home{};
  const int count = mechanism->axis_count();
  ASSERT_EQ(mechanism->inverse(machine.X_BT_home, {}, std::span(home).first(static_cast<std::size_t>(count))),
            kinematics::SolveStatus::ok);
  const GcodeFamily family = gcode_family(GetParam().first);
  const GcodeAxes axes = gcode_axes(family, machine, {});
  std::vector<std::string> lines;
  const FitTolerance tolerance;
  PostPort port(machine, {family, axes, tolerance}, home, [&](const std::string& l) { lines.push_back(l); });
  port.begin();
  const auto path = path_from(home, count);
  ASSERT_EQ(port.submit(path, 1e9), machine::Status::ok);
  ASSERT_EQ(port.wait_until(3), machine::Status::ok);
  const auto blocks = read_back(lines, family != GcodeFamily::marlin);
  ASSERT_EQ(blocks.size(), port.figures().blocks);
  const auto point = [&](double time, const std::function<double(int)>& value) {
    TimedPoint timed{time, {}};
    for (int i = 0; i < count; ++i)
      timed.at.push_back(value(i) /
                         (axes.turns[static_cast<std::size_t>(i)] ? tolerance.angle : tolerance.length));
    return timed;
  };
  const auto letter = [&](int i) { return axes.letters[static_cast<std::size_t>(i)]; };
  double time = 0;
  std::vector<TimedPoint> points{point(0, [&](int i) { return home[static_cast<std::size_t>(i)]; })};
  for (const Read& block : blocks)
    points.push_back(
        point(time += block.duration, [&](int i) { return axes.unit(i) * block.at.at(letter(i)); }));
  EXPECT_NEAR(time, 2, 1.1e-3) << "a sample";
  for (const Setpoint& s : path)
    // 0.1 of the tolerance: home is written to 0.1 um, and a setpoint lies between two samples.
    ASSERT_LT(path_distance(point(s.time, [&](int i) { return s.position[static_cast<std::size_t>(i)]; }),
                            points, tolerance.time),
              1.1)
        << "at " << s.time;
}

INSTANTIATE_TEST_SUITE_P(Families, PostedFor,
                         testing::Values(std::pair("grblhal", "hexapod"), std::pair("marlin", "hexapod"),
                                         std::pair("reprapfirmware", "hexapod"),
                                         std::pair("marlin", "five-axis"), std::pair("grblhal", "arm")));

TEST(PostPort, NamesEveryAxisAtTheStartAndWritesOutputs) {
  const auto machine = machine::load_machine("hexapod");
  machine::AxisVector home{};
  home.fill(0.2);
  std::vector<std::string> lines;
  PostPort port(machine, {GcodeFamily::marlin, gcode_axes(GcodeFamily::marlin, machine, {}), {}}, home,
                [&](const std::string& line) { lines.push_back(line); });
  port.begin();
  ASSERT_EQ(port.set_outputs({483.15, 0.5}, 1), machine::Status::ok);
  ASSERT_EQ(port.set_outputs({}, 1), machine::Status::ok);
  // From 1 mm beside it in X Y Z, sqrt(3) mm in 5 s.
  EXPECT_THAT(
      lines, testing::ElementsAre("G21", "G90", "M82", "G92 E0", "G1 X200 Y200 Z200 U200 V200 W200 F20.78461",
                                  "M109 S210", "M106 S128", "M104 S0", "M107"));
}

}  // namespace
}  // namespace understudy::drivers
