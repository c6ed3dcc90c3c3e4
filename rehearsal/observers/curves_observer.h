// Keeps the curves of a run in bounded memory: of each stretch of time the least and the most.
#pragma once

#include "rehearsal/observers/run_curves.h"
#include "sim/collision/collision.h"
#include "sim/deposition/deposition.h"
#include "sim/observer.h"

namespace understudy::rehearsal {

class CurvesObserver : public sim::Observer {
 public:
  static constexpr std::size_t kCapacity = 1000;

  /// Reads temperatures from `deposition` and clearances from `collision`, which must have seen each snapshot
  /// before; null: there are none. Flips are those of the first `struts` drives. Of the run at most
  /// `capacity` stretches are kept: when they are full, every two become one.
  CurvesObserver(const sim::DepositionObserver& deposition, const sim::CollisionObserver* collision,
                 int struts, std::size_t capacity = kCapacity);

  void observe(const sim::Snapshot& snapshot) override;
  RunCurves take();

 private:
  void join_pairs();

  const sim::DepositionObserver& deposition_;
  const sim::CollisionObserver* collision_;
  sim::LoadFlips flips_;
  std::size_t capacity_;
  std::size_t stride_ = 1, in_last_ = 0;  ///< snapshots a stretch, and in the newest one
  std::vector<CurveStretch> stretches_;
};

}  // namespace understudy::rehearsal
