// Private to this folder: what a robot's program does, statement by statement, before it is known which of
// its outputs feeds filament, which base the part stands in, and which way its tool points.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "toolpath/robot/robot_program.h"

namespace understudy::toolpath {

/// A base, in the frame that the program counts bases in; without a pose, it is known by its name alone.
struct RobotBase {
  std::string name;
  std::optional<Pose> X;
};

struct RobotMove {
  enum class Kind : unsigned char {
    straight,  ///< LIN, MoveL, and chords of arcs
    free,      ///< PTP, MoveJ: by a path of the robot's own
    axes,      ///< by axis values
    wait,
    output,  ///< sets `output` to `value`
    end,
  };
  Kind kind = Kind::straight;
  Pose X_UN = Pose::Identity();
  double feed = 0;      ///< [m/s]; 0 of `free`: as fast as the robot goes
  double duration = 0;  ///< [s], of a wait, or of a move where above 0
  double value = 0;
  int base = 0, output = 0;  ///< indices
  int line = 0;
};

class RobotPath {
 public:
  /// `chords_max`: of all arcs together.
  explicit RobotPath(std::string file, std::size_t chords_max = kMostChords)
      : file_(std::move(file)), chords_max_(chords_max) {}

  /// Of what comes next.
  void set_line(int line) { line_ = line; }
  /// Bases of one name and pose are one.
  void set_base(const RobotBase& base);
  void set_tool(const std::string& name) { tool_ = name; }

  // These throw InputError for coordinates or times that no machine can mean.

  /// Straight to X_UN at `feed` [m/s], or in `duration` [s] where that is above 0.
  void straight(const Pose& X_UN, double feed, double duration = 0);
  void free(const Pose& X_UN, double feed = 0);
  /// Round, through `via`; `angle` [rad] as arc_through() takes it.
  void arc(const Vec3& via_U, const Pose& X_UN, std::optional<double> angle, double feed,
           double duration = 0);
  void axes();
  void wait(double seconds);
  /// From here on; `after_next`: from the end of the next move on.
  void set_output(const std::string& name, double value, bool analogue, bool after_next = false);
  void end();

  /// In the present base. Nothing: the program has not said yet.
  const std::optional<Pose>& X_UN() const { return X_UN_; }
  [[noreturn]] void fail(const std::string& message) const;

  const std::string& file() const { return file_; }
  bool has_moves() const { return !facts.tools.empty() || facts.axis_moves > 0; }
  const std::vector<RobotMove>& moves() const { return moves_; }
  const std::vector<RobotBase>& bases() const { return bases_; }
  RobotFacts facts;  ///< of these moves; the reader adds its statements

 private:
  RobotMove& add(RobotMove::Kind kind);
  void line(const Pose& X_UN, double feed, double duration);
  void count_move(double feed);
  void finish_move();
  void require_place(const Pose& X, const std::string& whose = "") const;
  int output_index(const std::string& name, bool analogue);

  std::string file_, tool_;
  std::size_t chords_ = 0, chords_max_;
  int line_ = 0;
  int base_ = -1;
  std::optional<Pose> X_UN_;
  std::vector<RobotMove> moves_;
  std::vector<RobotBase> bases_;
  std::vector<RobotMove> after_next_;
};

/// The steps of a path. Throws InputError where the options do not tell what the path leaves open.
Program resolve(const RobotPath& path, const RobotOptions& options);

}  // namespace understudy::toolpath
