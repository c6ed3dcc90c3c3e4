// What comes out of the queue is what went in: in order, once, at its time.
#include "machine/setpoint_queue.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include "tests/property.h"

namespace understudy::machine {
namespace {

using property::real;
using property::whole;

constexpr double kEndless = std::numeric_limits<double>::infinity();

SetpointQueue queue_of(std::size_t capacity) {
  SetpointQueueOptions options;
  options.capacity = capacity;
  options.ranges = {{-kEndless, kEndless}, {-kEndless, kEndless}};
  options.rest_velocity.fill(1e-6);
  return {options, {}, 0};
}

Setpoint drawn_setpoint(double time, int line) {
  Setpoint s;
  s.time = time;
  for (std::size_t i = 0; i < 2; ++i) {
    s.position[i] = *real(-1, 1);
    s.velocity[i] = *real(-2, 2);
  }
  s.filament = *real(0, 1);
  s.line = line;
  return s;
}

// A small queue that is often full, against a list without end.
TEST(SetpointQueueProperties, EverySetpointIsExecutedOnceInOrderAndNotBeforeItsTime) {
  property::check({2000, 60}, [] {
    const std::size_t capacity = static_cast<std::size_t>(*whole(1, 9));
    SetpointQueue queue = queue_of(capacity);
    std::deque<Setpoint> model;
    std::uint64_t accepted = 0, executed = 0;
    double now = 0, last = 0;
    int line = 0;
    for (int steps = *rc::gen::inRange(1, 40); steps > 0; --steps) {
      if (*whole(0, 1) == 0) {
        std::vector<Setpoint> some;
        double time = std::max(now, last);
        for (int n = *whole(1, 4); n > 0; --n)
          some.push_back(drawn_setpoint(time += *real(1e-3, 0.1), ++line));
        const Status expected = some.size() > capacity                  ? Status::rejected
                                : model.size() + some.size() > capacity ? Status::queue_full
                                                                        : Status::ok;
        RC_ASSERT(queue.submit(some, now) == expected);
        if (expected != Status::ok) continue;
        model.insert(model.end(), some.begin(), some.end());
        accepted += some.size();
        last = time;
      } else {
        now += *real(0, 0.2);
        while (const Setpoint* done = queue.execute_next(now)) {
          RC_ASSERT(!model.empty());
          RC_ASSERT(done->line == model.front().line);
          RC_ASSERT(done->time <= now);
          model.pop_front();
          ++executed;
        }
        RC_ASSERT((model.empty() || model.front().time > now));  // RapidCheck looks at both sides
      }
      RC_ASSERT(queue.accepted() == accepted);
      RC_ASSERT(queue.executed() == executed);
      RC_ASSERT(queue.free_slots() == capacity - model.size());
    }
  });
}

// Through every setpoint with its velocity; between two, as any cubic of these ends: Simpson's rule over the
// velocities is exact for it. Filament stays between the two.
TEST(SetpointQueueProperties, TheTargetPassesThroughEverySetpointAndItsVelocityIsItsDerivative) {
  property::check({2000}, [] {
    SetpointQueue queue = queue_of(4);
    const double first = *real(0.01, 0.2), second = first + *real(1e-3, 0.2);
    const std::vector<Setpoint> two = {drawn_setpoint(first, 1), drawn_setpoint(second, 2)};
    RC_ASSERT(queue.submit(two, 0) == Status::ok);
    SetpointQueue::Target at = queue.advance_to(first);
    for (std::size_t i = 0; i < 2; ++i) {
      RC_ASSERT(std::abs(at.position[i] - two[0].position[i]) < 1e-14);
      RC_ASSERT(std::abs(at.velocity[i] - two[0].velocity[i]) < 1e-11);
    }
    const double end = first + *real(0.05, 0.95) * (second - first), middle = 0.5 * (first + end);
    const SetpointQueue::Target half = queue.advance_to(middle), whole_way = queue.advance_to(end);
    for (std::size_t i = 0; i < 2; ++i) {
      const double mean = (two[0].velocity[i] + 4 * half.velocity[i] + whole_way.velocity[i]) / 6;
      RC_ASSERT(std::abs(whole_way.position[i] - at.position[i] - mean * (end - first)) < 1e-12);
    }
    const auto [least, most] = std::minmax(two[0].filament, two[1].filament);
    RC_ASSERT(half.filament >= least && half.filament <= most);
    at = queue.advance_to(second);
    for (std::size_t i = 0; i < 2; ++i) RC_ASSERT(std::abs(at.position[i] - two[1].position[i]) < 1e-14);
    RC_ASSERT(at.filament == two[1].filament);
  });
}

// A hold at any moment: the axes go on along the path that is queued, and never back.
TEST(SetpointQueueProperties, AHoldStaysOnTheQueuedPathAndLosesNothing) {
  property::check({300}, [] {
    SetpointQueue queue = queue_of(3000);
    constexpr double kCycle = 1e-3, kStep = 0.5e-3;
    const int count = *whole(300, 1500);
    std::vector<Setpoint> line;
    for (int i = 1; i <= count; ++i) {
      Setpoint s;
      s.time = kCycle * i;
      s.position[0] = 0.01 * s.time;
      if (i < count) s.velocity[0] = 0.01;
      s.line = i;
      line.push_back(s);
    }
    RC_ASSERT(queue.submit(line, 0) == Status::ok);
    const int hold_at = *whole(0, count), resume_at = hold_at + *whole(0, 600);
    double former = 0, held_for = 0;
    for (int n = 1; n < 20000 && queue.free_slots() < 3000; ++n) {
      const double now = n * kStep;
      if (n == hold_at) queue.hold();
      if (n == resume_at) queue.resume();
      queue.pass(kStep, now);
      const double position = queue.advance_to(now).position[0];
      RC_ASSERT(position >= former - 1e-15);
      RC_ASSERT(position - former <= 0.0134 * kStep);  // 4/3 of the speed where the last cycle stops
      former = position;
      held_for = now;
    }
    RC_ASSERT(queue.executed() == line.size());
    RC_ASSERT(std::abs(former - line.back().position[0]) < 1e-15);
    RC_ASSERT(held_for >= line.back().time - 1e-12);
    RC_ASSERT(std::abs(queue.lag() - (held_for - line.back().time)) <= 2 * kStep);
  });
}

}  // namespace
}  // namespace understudy::machine
