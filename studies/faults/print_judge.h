// Whether a part is spoilt, from the truth alone: the program, the tolerances of the machine file, and where
// the tip truly went. It shares nothing with the code that says go or no-go, so that the two can disagree.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geometry/mesh.h"
#include "machine/description.h"
#include "rehearsal/record.h"
#include "toolpath/program.h"

namespace understudy::studies {

/// What a part may be off by; of the machine file.
struct PrintTolerances {
  double tip = 0;                   ///< [m]
  double orientation = 0;           ///< [rad]
  double gap_min = 0, gap_max = 0;  ///< [m]
  double gap_above = 0;             ///< [m], of gap_max over the gap that the machine aims at
  /// [m], of the nozzle. What is too low, missing or loose for less than that of the path is covered by what
  /// is laid before and after it; where what lies below is too far, a bead reaches by as much from either
  /// end.
  double bore = 0;
};
/// Throws InputError for a machine that is not known.
PrintTolerances tolerances_of(const std::string& machine_word);

/// What the program asks for, place by place, a quarter of a bore of path each.
class IntendedPrint {
 public:
  /// `part` as drawn; null: the table alone.
  IntendedPrint(const toolpath::Program& program, const geometry::Mesh* part,
                const PrintTolerances& tolerances);

  struct Place {
    double length = 0;       ///< [m]
    bool on_ground = false;  ///< over part or table, not over beads: the nozzle may not come too near
    bool lies = false;       ///< on part, table or a bead before it: the bead may not hang
    /// [m], above which a bead hangs: gap_max, or as much over the programmed layer as that over the aim.
    double highest = 0;
  };
  const std::vector<Place>& places() const { return places_; }
  const PrintTolerances& tolerances() const { return tolerances_; }
  double filament() const { return filament_; }  ///< [m], net, of the whole program
  double path() const { return path_; }          ///< [m], with extrusion

  /// The nearest place that is printed on this line or next to it.
  struct Nearest {
    std::size_t place = 0;
    double distance = 0;  ///< [m]
    double angle = 0;     ///< [rad], between the tool axes: a nozzle is round
  };
  Nearest nearest(int line, const Pose& X_WT) const;
  /// Marks the places of these lines that lie within the tip's tolerance of a tip that lays a bead.
  void cover(int line, const Vec3& tip_W, std::vector<bool>& covered) const;

 private:
  struct Segment {
    Vec3 from_W, to_W, axis_from_W, axis_to_W;
    int line = 0;
    std::size_t first_place = 0, places = 0;
  };
  using Segments = std::vector<Segment>;
  /// Of the line and those next to it; all where there are none.
  std::pair<Segments::const_iterator, Segments::const_iterator> near(int line) const;
  void add_segment(const toolpath::Step& step, const Pose& X_WT_before, const geometry::Mesh* part);
  void add_place(const Pose& X_WT, double length, const geometry::Mesh* part);

  PrintTolerances tolerances_;
  Segments segments_;  // by line
  std::vector<Place> places_;
  std::vector<Vec3> tips_W_;  // in the middle of each
  std::vector<double> ways_;  // [m] of path with extrusion, likewise
  double filament_ = 0, path_ = 0;
};

/// What was found wrong with a part.
enum class Flaw { incomplete, tip, orientation, too_low, too_high, loose, touched };
constexpr int kFlaws = 7;
const char* to_string(Flaw flaw);

struct PrintTruth {
  unsigned flaws = 0;               ///< a bit for each Flaw
  double tip_max = 0;               ///< [m], from the programmed path while extruding
  double orientation_max = 0;       ///< [rad]
  double missing = 0;               ///< [m] of programmed path with no bead within the tip's tolerance
  double too_low = 0;               ///< [m], longest stretch of path
  double too_high = 0;              ///< [m], likewise
  double gap_min = 0, gap_max = 0;  ///< [m], where a bead is to lie on something; 0 where nothing is
  bool spoilt() const { return flaws != 0; }
  bool has(Flaw flaw) const { return (flaws >> static_cast<unsigned>(flaw) & 1U) != 0; }
};
/// "tip, too high"; empty for a good part.
std::string flaw_words(unsigned flaws);

/// `run` is the record of the program that `intended` is made of; its verdict and findings are not looked at.
PrintTruth judge_print(const IntendedPrint& intended, const rehearsal::Record& run);

}  // namespace understudy::studies
