#include "sim/twin/observer_thread.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <stdexcept>
#include <thread>

#include "core/error.h"
#include "core/thread_limit.h"

namespace understudy::sim {
namespace {

class Recorder : public Observer {
 public:
  void observe(const Snapshot& s) override {
    if (s.time == fail_at) throw std::runtime_error("cannot see this");
    times.push_back(s.time);
    threads.insert(std::this_thread::get_id());
  }
  std::vector<double> times;
  std::set<std::thread::id> threads;
  double fail_at = -1;
};

Snapshot at_time(double time) {
  Snapshot s;
  s.time = time;
  return s;
}

TEST(ObserverThread, EveryObserverSeesEverySnapshotInOrder) {
  Recorder first, second;
  ObserverThread thread({&first, &second});
  std::vector<double> expected;
  for (int k = 0; k < 20'000; ++k) {
    thread.observe(at_time(k));
    expected.push_back(k);
  }
  thread.drain();
  EXPECT_EQ(first.times, expected);
  EXPECT_EQ(second.times, expected);
}

TEST(ObserverThread, AfterDrainNothingIsOnItsWay) {
  Recorder recorder;
  ObserverThread thread({&recorder});
  for (std::size_t k = 1; k <= 500; ++k) {
    thread.observe(at_time(static_cast<double>(k)));
    thread.drain();
    ASSERT_EQ(recorder.times.size(), k);
  }
}

void fail_at_the_seventh() {
  Recorder recorder;
  recorder.fail_at = 7;
  ObserverThread thread({&recorder});
  for (int k = 0; k < 20; ++k) thread.observe(at_time(k));
  try {
    thread.drain();
    FAIL() << "nothing was thrown";
  } catch (const MachineError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("cannot see this"));
  }
  EXPECT_THROW(thread.drain(), MachineError);
  EXPECT_EQ(recorder.times.size(), 7u);
}

TEST(ObserverThread, AnObserverThatFailsEndsTheRun) { fail_at_the_seventh(); }

class ObserverThreadOfOne : public testing::Test {
 protected:
  ObserverThreadOfOne() { limit_threads(1); }
  ~ObserverThreadOfOne() override { limit_threads(std::numeric_limits<int>::max()); }
};

TEST_F(ObserverThreadOfOne, CallsOnTheThreadOfTheRun) {
  Recorder recorder;
  ObserverThread thread({&recorder});
  std::vector<double> expected;
  for (int k = 0; k < 1000; ++k) {
    thread.observe(at_time(k));
    expected.push_back(k);
  }
  thread.drain();
  EXPECT_EQ(recorder.times, expected);
  EXPECT_EQ(recorder.threads, std::set{std::this_thread::get_id()});
}

TEST_F(ObserverThreadOfOne, AnObserverThatFailsEndsTheRun) { fail_at_the_seventh(); }

TEST(ObserverThread, EndsWithoutDrain) {
  Recorder recorder;
  {
    ObserverThread thread({&recorder});
    for (int k = 0; k < 1000; ++k) thread.observe(at_time(k));
  }
  EXPECT_LE(recorder.times.size(), 1000u);
}

}  // namespace
}  // namespace understudy::sim
