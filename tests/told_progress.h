// What a long task told of its progress.
#pragma once

#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/progress.h"

namespace understudy::test {

class ToldProgress {
 public:
  Progress teller() {
    return [this](double share, const std::string& what) {
      shares_.push_back(share);
      stages_.insert(what);
    };
  }

  const std::set<std::string>& stages() const { return stages_; }
  std::size_t times() const { return shares_.size(); }

  /// Forwards, from where it begins to its end, in steps of which none is more than `leap` of the task.
  void expect_even(double leap) const {
    ASSERT_FALSE(shares_.empty());
    double last = 0;
    for (const double share : shares_) {
      EXPECT_GE(share, last);
      EXPECT_LE(share, last + leap);
      last = share;
    }
    EXPECT_DOUBLE_EQ(last, 1);
  }

 private:
  std::vector<double> shares_;
  std::set<std::string> stages_;
};

}  // namespace understudy::test
