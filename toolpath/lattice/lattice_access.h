// Whether the tool can get at a strut, print it and get away, with some struts built.
#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "toolpath/lattice/disassembly.h"
#include "toolpath/lattice/lattice_sequence.h"
#include "toolpath/lattice/tool_envelope.h"
#include "toolpath/lattice/tool_escape.h"

namespace understudy::toolpath {

/// Tool axes to try, from vertical outwards.
std::vector<Vec3> tool_axes(double tilt_max);

/// Remembers of every strut, end and axis what was in its way last, and looks again only when that is gone.
class StrutAccess {
 public:
  StrutAccess(const Lattice& lattice, const SequenceLimits& limits);

  /// The first axis with which the strut can be printed from `removal.from` on while `standing` (by strut)
  /// are built. False when there is none. Fills everything of `print`.
  bool find(const Removal& removal, const std::vector<char>& standing, StrutPrint& print);

  /// What is in the way of printing the strut with the tool along `axis`, from in along the axis until out
  /// along it, or nothing; the machine is not asked. Fills `print` but for arrival and departure.
  std::string blocked(const Removal& removal, const Vec3& axis, const std::vector<char>& standing,
                      StrutPrint& print) const;

  /// A strut as it is printed.
  const StrutBody& body(int strut) const { return bodies_[static_cast<std::size_t>(strut)]; }

  /// More struts stand again than at the last find().
  void put_back() { ++round_; }

  /// Whether no axis can ever print the strut, in either direction, with nothing else built; and why.
  bool never(int strut, std::string& why) const;

  struct Obstacle {
    double lack =
        std::numeric_limits<double>::infinity();  ///< [m], by how much it is too near; no axis at all
    double distance = 0, limit = 0;               ///< [m], of the surfaces; below 0 the tool cuts in, or may
    int strut = -1;                               ///< the one that is too near; -1: none
    std::string why;  ///< where it is none: what the machine, the table or travel says
  };
  /// The axis, among those that the machine and the table allow, that lacks least, and what it lacks
  /// it to.
  Obstacle clearest(const Removal& removal, const std::vector<char>& standing, StrutPrint& print) const;

  /// The ways in and out along the axis and straight up, whatever is there.
  void complete_anyhow(StrutPrint& print) const;

 private:
  enum class Fit : unsigned char { unknown, never, possible };
  // One strut, end and axis.
  struct Case {
    Fit fit = Fit::unknown;
    bool on_top = false;  // of another strut, at a grounded node: what the rest holds for
    int obstacle = -1;    // the strut that was in its way last
    int clear_to = 0;     // in from_top_: what stands before it was not, as long as none was put back
    int round = 0;        // when that was
  };
  std::vector<Case>& cases(int strut, int from);
  bool lies(int strut) const;
  bool meets_another(int node, int strut, const std::vector<char>& standing) const;
  Vec3 tip_at(int node, const Vec3& axis, bool on_top) const;
  StrutBody as_printed(int strut) const;
  StrutBody fresh(const StrutPrint& print) const;
  StrutPrint print_along(const Removal& removal, const Vec3& axis, const std::vector<char>& standing) const;
  std::string ruled_out(const StrutPrint& print) const;
  std::string meets_itself(const StrutPrint& print) const;
  std::string beyond_reach(const StrutPrint& print) const;
  bool near(const StrutPrint& print, const StrutBody& other) const;
  bool clears(const StrutPrint& print, int other) const;
  struct Piece {
    StrutBody body;
    const ToolEnvelope* tool = nullptr;
    double margin = 0, press = 0;  // [m], what the envelope counts into distances
  };
  struct Pieces {
    std::array<Piece, 2> of{};
    int count = 0;
  };
  Pieces pieces(const StrutPrint& print, int other) const;
  Obstacle lacks(const StrutPrint& print, int other, double enough, double tolerance) const;
  void raise(StrutPrint& print, const std::vector<StrutBody>& built) const;
  /// Adds the way in and the way out; what hinders them, or nothing.
  std::string complete(StrutPrint& print, const std::vector<char>& standing) const;

  const Lattice& lattice_;
  const SequenceLimits& limits_;
  ToolEnvelope tool_, joint_tool_;      // at joints the nozzle may press
  ToolEnvelope lifted_, lifted_joint_;  // the same on their way out
  ToolEscape escape_;
  std::vector<Vec3> axes_;
  std::vector<std::vector<int>> touching_;  // struts at each node
  std::vector<StrutBody> bodies_;           // by strut, as printed
  std::vector<std::vector<Case>> cases_;    // two of each strut: from its first node, from its second
  std::vector<int> from_top_;               // struts, highest first
  int round_ = 0;                           // how often struts were put back
  double highest_ = 0;                      // [m], of all struts
};

}  // namespace understudy::toolpath
