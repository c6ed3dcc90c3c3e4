// Volume is kept: whatever path, feed and retraction, what was fed lies in beads or is still in the nozzle.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "sim/deposition/bead_section.h"
#include "sim/deposition/extruder.h"
#include "tests/property.h"
#include "tests/sim/deposition/laying.h"

namespace understudy::sim {
namespace {

using property::real;
using property::whole;

// docs/printing.md: everything that goes in comes out. Nothing is sucked back, so what was pulled back below
// the fullest state is air and no volume.
TEST(ExtruderProperties, WhatIsFedHasLeftOrStillPresses) {
  property::check({3000}, [] {
    const double lag = *rc::gen::element(0.0, 1.0) * *property::magnitude(1e-3, 0.5);
    Extruder extruder(lag);
    double fed = 0, out = 0;
    for (int n = *rc::gen::inRange(1, 50); n > 0; --n) {
      const double step = *real(-2e-3, 3e-3),
                   duration = *whole(0, 9) == 0 ? 0 : *property::magnitude(1e-4, 1);
      const double column = extruder.column();
      fed += step;
      const Extruder::Flow flow = extruder.advance(fed, duration);
      out += flow.filament;
      RC_ASSERT(flow.filament >= 0);
      RC_ASSERT(flow.from >= 0 && flow.from <= 1);
      RC_ASSERT(flow.filament <= std::max(0.0, column) + std::max(0.0, step) + 1e-15);
      RC_ASSERT(std::abs(fed - out - extruder.column()) < 1e-15 * 50);
      if (lag == 0) RC_ASSERT(extruder.column() <= 0);
    }
  });
}

// However an interval is cut, the same flows: the lag is solved, not stepped.
TEST(ExtruderProperties, CuttingAnIntervalChangesNothing) {
  property::check({3000}, [] {
    const double lag = *property::magnitude(1e-3, 0.5), before = *real(-2e-3, 2e-3);
    const double step = *real(-2e-3, 2e-3), duration = *property::magnitude(1e-3, 1);
    const int parts = *whole(2, 20);
    Extruder whole_way(lag), in_parts(lag);
    whole_way.advance(before, 0.05);
    in_parts.advance(before, 0.05);
    const double once = whole_way.advance(before + step, duration).filament;
    double sum = 0;
    for (int k = 1; k <= parts; ++k)
      sum += in_parts.advance(before + step * k / parts, duration / parts).filament;
    RC_ASSERT(std::abs(once - sum) < 1e-14);
    RC_ASSERT(std::abs(whole_way.column() - in_parts.column()) < 1e-14);
  });
}

// The section of the width has the area: flat with round edges, or a round strand.
TEST(BeadSectionProperties, TheWidthHasTheAreaThatWasFed) {
  property::check({3000}, [] {
    const double area = *property::magnitude(1e-10, 5e-6), gap = *real(-0.1e-3, 1e-3);
    const double width = bead_width(area, gap);
    const double round = std::sqrt(4 * area / std::numbers::pi);
    if (gap <= 0 || round < gap) {
      RC_ASSERT(std::abs(width - round) < 1e-9 * round);
    } else {
      const double found = (width - gap) * gap + std::numbers::pi / 4 * gap * gap;
      RC_ASSERT(std::abs(found - area) < 1e-9 * area);
      RC_ASSERT(width >= gap * (1 - 1e-12));
    }
  });
}

/// What a print does, one snapshot after the other: over the table, through the air, back over its own beads.
/// It ends fed as far as ever, so that nothing is drawn back.
struct Fed {
  double filament = 0, most = 0;  ///< [m]
};

Fed lay_at_random(Laying& laying, int snapshots) {
  Vec3 tip(0, 0, 0.15e-3);
  double time = 0;
  Fed fed;
  laying.observe(at(0, tip, 0));
  int line = 1;
  while (snapshots > 0) {
    // A stretch of its own velocity and feed; sometimes at rest, feeding or drawing back.
    const int kind = *whole(0, 6);
    Vec3 step = kind < 2 ? Vec3(0, 0, 0) : Vec3(*property::vector(0.05e-3));
    step.z() = 0;
    const double height = *real(-0.05e-3, 0.4e-3);
    const double feed = kind == 0 ? *real(-20e-6, 0) : kind == 6 ? 0 : *real(0, 10e-6);
    const Mat3 R = exp_rotation(*property::vector(0.2));
    ++line;
    for (int n = *whole(1, 60); n > 0 && snapshots > 0; --n, --snapshots) {
      time += 2e-3;
      tip += step;
      tip.z() += 0.2 * (height - tip.z());
      fed.filament += feed;
      fed.most = std::max(fed.most, fed.filament);
      Snapshot s = at(time, tip, fed.filament, line, R);
      s.nozzle_temperature = 480;
      laying.observe(s);
    }
  }
  fed.filament = fed.most += 5e-6;
  laying.observe(at(time + 2e-3, tip + Vec3(10e-6, 0, 0), fed.filament, line));
  return fed;
}

TEST(DepositionProperties, WhatWasFedLiesInBeadsOrIsStillInTheNozzle) {
  property::check({300, 100}, [] {
    machine::MachineDescription machine = printer();
    machine.process.extruder_lag = *rc::gen::element(0.0, 0.02, 0.1);
    DepositionOptions options;
    if (*whole(0, 1) == 1) {
      options.glass_transition = 330;
      options.substrate_temperature = [](double, double) { return 300.0; };
    }
    Laying laying(machine, nullptr, options);
    const Fed fed = lay_at_random(laying, *rc::gen::inRange(1, 1500));
    const double in = kFilamentArea * fed.most;

    const DepositionSummary summary = laying.summary();
    const double rounding = 1e-12 * (1e-9 + in) + 1e-18;
    RC_LOG() << "fed " << in << " laid " << summary.laid_volume << " column " << summary.column_volume
             << "\n";
    RC_ASSERT(std::abs(summary.extruded_volume - in) < rounding);
    RC_ASSERT(std::abs(summary.laid_volume + summary.column_volume - in) < 1e-9 * in + 1e-18);

    double total = 0, sticking = 0, standing = 0;
    for (const LaidBead& bead : laying.beads()) {
      RC_ASSERT(bead.volume >= 0);
      total += bead.volume;
      if (bead.adhesion == Adhesion::sticks || bead.adhesion == Adhesion::fused) sticking += bead.volume;
      const bool drop = bead.adhesion == Adhesion::unsupported && !bead.follows && bead.length < bead.width;
      if (bead.length == 0 || drop) standing += bead.volume;
      RC_ASSERT(bead.width >= 0 && bead.height >= 0 && std::isfinite(bead.width + bead.height));
      RC_ASSERT(bead.time >= bead.start_time && bead.line >= bead.start_line);
    }
    RC_ASSERT(std::abs(total - summary.laid_volume) < rounding);
    RC_ASSERT(std::abs(sticking - summary.deposited_volume) < rounding);
    RC_ASSERT(std::abs(standing - summary.standstill_volume) < rounding);
    RC_ASSERT(summary.beads == laying.beads().size());

    double hanging = 0;
    for (const UnsupportedStretch& stretch : laying.unsupported_stretches()) hanging += stretch.volume;
    RC_ASSERT(hanging <= total - sticking + rounding);
    const double shares =
        summary.in_band_fraction + summary.below_band_fraction + summary.above_band_fraction;
    if (summary.length > 0) RC_ASSERT(std::abs(shares - 1) < 1e-9);
  });
}

}  // namespace
}  // namespace understudy::sim
