// Gathers short pieces of extrusion into elements of one section.
#pragma once

#include <functional>
#include <limits>
#include <optional>

#include "sim/deposition/deposition.h"

namespace understudy::sim {

/// A point of the tip's path and what is below it.
struct PathPoint {
  double time = 0;  ///< [s]
  Vec3 tip_W{0, 0, 0}, axis_W{0, 0, 1};
  double gap = 0;       ///< [m]; infinity: nothing below
  Vec3 foot_W() const;  ///< on what is below
  /// Where material comes to lie: what is unsupported stays where it comes out.
  Vec3 laid_W(Adhesion adhesion) const { return adhesion == Adhesion::unsupported ? tip_W : foot_W(); }
};

/// An element as it grows, with what its public face leaves out.
struct Element {
  LaidBead bead;
  Vec3 tip_from_W{0, 0, 0}, tip_to_W{0, 0, 0};
  double worst_gap = 0;                                      ///< [m], farthest from the band
  double carrier = std::numeric_limits<double>::infinity();  ///< [m], as in Below
  BarePath bare_before;                                      ///< as in UnsupportedStretch
};

/// What an element is pressed on.
struct Below {
  double fused_height = 0;                                   ///< [m], what a fused element gets
  double carrier = std::numeric_limits<double>::infinity();  ///< [m], carrier_width()
};

class BeadBuilder {
 public:
  /// What is wider than `widest_line` [m] and than its own length is no line.
  BeadBuilder(double widest_line, std::function<void(const Element&)> done)
      : done_(std::move(done)), widest_line_(widest_line) {}

  /// From a to b nothing changes but linearly.
  void extrude(const PathPoint& a, const PathPoint& b, Adhesion adhesion, double volume, int line,
               const Below& below);
  /// The tip went on without extrusion: by so much path since the last element's end [m] it is another.
  void pause(double path);
  /// As pause(); the path belongs to the element that follows at once.
  void prime(const BarePath& path);
  /// Volume that came out while the drive did not feed: it stays at the last element.
  void ooze(double volume);
  /// Hands out what still grows.
  void close();

  double last_width() const { return last_width_; }
  double carried_volume() const { return carried_; }

 private:
  void begin(const PathPoint& at, Adhesion adhesion, int line);
  void grow(const PathPoint& a, const PathPoint& b, double volume, int line);
  bool goes_on(const PathPoint& a, const PathPoint& b, Adhesion adhesion, double volume) const;
  void settle_section();
  double area_of(const LaidBead& bead);
  void settle_blob(double height);

  std::function<void(const Element&)> done_;
  std::optional<Element> element_;
  double fused_height_ = 0;
  double moment_ = 0;        // integral of the gap over the length
  Vec3 heading_{0, 0, 0};    // of the first tenth of a millimetre, zero until then
  bool may_grow_ = false;    // false: extrusion paused
  bool continuous_ = false;  // nothing but extrusion since the last element's end
  double idle_path_ = 0;     // [m] since then
  BarePath primed_;          // up to here
  double carried_ = 0;       // [m^3], oozed where no element was open
  double last_width_ = 0;
  double last_area_ = 0;  // [m^2], of the last element
  double widest_line_;    // [m]
};

}  // namespace understudy::sim
