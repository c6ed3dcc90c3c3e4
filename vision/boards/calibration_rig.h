// The two-camera measuring set-up (Song 2015, appendix B; docs/reference.md#two-cameras): plain data, SI.
//
// Two cameras look at the working volume at right angles. A printed chessboard stands upright before each of
// them at `layers` depths; three spheres on the moving platform are what is measured later. Frames: G the
// chessboard's grid (origin in the middle of the corners, x along a row to the right, y down, z away from
// the camera), C a camera, T the tool, W the world.
#pragma once

#include <array>
#include <vector>

#include "core/frames.h"
#include "core/image.h"
#include "core/random.h"

namespace understudy::vision {

/// A printed chessboard. Exactly one of columns and rows is odd: then it differs from itself upside down.
struct Board {
  int columns = 12;        ///< of inner corners
  int rows = 9;            ///< of inner corners
  double square = 10e-3;   ///< [m], side
  double margin = 2.5e-3;  ///< [m] of white paper around the squares

  int corners() const { return columns * rows; }
  /// [m], from the middle to the farthest corner along x and along y.
  Vec2 half_size() const { return 0.5 * square * Vec2(columns - 1, rows - 1); }
  /// In G, row by row; the first is at the upper left.
  Vec3 corner(int column, int row) const {
    return {square * (column - 0.5 * (columns - 1)), square * (row - 0.5 * (rows - 1)), 0};
  }
};

/// How far a board is from where it is believed to be: p_G is really at exp(rotation) (1 + scale) p + offset.
struct BoardPlacement {
  Vec3 offset{0, 0, 0};    ///< [m], along the axes of G
  Vec3 rotation{0, 0, 0};  ///< [rad], rotation vector in G
  double scale = 0;        ///< of the print, relative

  Vec3 moved(const Vec3& p_G) const { return exp_rotation(rotation) * ((1 + scale) * p_G) + offset; }
};

/// How a print differs from its drawing. One board is moved from layer to layer before a camera, so its print
/// is the same in all of them.
struct PrintError {
  double scale = 0;  ///< relative
  /// [m], along z of G: b_0 X^2 + b_1 X Y + b_2 Y^2, with X and Y 1 at the farthest corners.
  Vec3 bow{0, 0, 0};

  Vec3 printed(const Board& board, const Vec3& p_G) const {
    const Vec2 at = p_G.head<2>().cwiseQuotient(board.half_size());
    const double bent = bow.dot(Vec3(at.x() * at.x(), at.x() * at.y(), at.y() * at.y()));
    return (1 + scale) * p_G + Vec3(0, 0, bent);
  }
};

/// Standard deviations, for each axis of each board on its own; of a print, common to all boards of a camera.
struct BoardTolerance {
  double offset = 0;       ///< [m]
  double rotation = 0;     ///< [rad]
  double scale = 0;        ///< relative
  double print_scale = 0;  ///< relative, of the print
  double flatness = 0;     ///< [m], each number of the print's bow
};

BoardPlacement sample_placement(const BoardTolerance& tolerance, Random& random);
PrintError sample_print(const BoardTolerance& tolerance, Random& random);

struct MountedCamera {
  Camera camera;
  Pose X_WC = Pose::Identity();
};

struct CalibrationRig {
  std::array<MountedCamera, 2> cameras;
  Board board;
  int layers = 11;
  double layer_spacing = 5e-3;   ///< [m]
  double middle_distance = 0.4;  ///< [m] from a camera to its middle layer
  std::array<Vec3, 3> targets;   ///< [m], centres of the spheres in T
  double target_radius = 0;      ///< [m]

  /// Where the board of a layer is meant to be; layer 0 is the nearest to the camera.
  Pose X_WG(int camera, int layer) const;
};

/// docs/reference.md#two-cameras: 1600 x 1200 px, f = 4267 px, so that 150 mm are seen at 400 mm. Camera 0
/// looks along +X, camera 1 along +Y, both upright and without distortion. The spheres have 5 mm radius and
/// form an equilateral triangle of 60 mm side: one in the tool tip, two higher up, symmetric about the plane
/// x = y, so that no one hides another in either view at tilts to 30 degrees. `home_tip_W`: the tip when the
/// middle of the triangle is in the middle of the volume.
CalibrationRig default_calibration_rig(const Vec3& home_tip_W);

}  // namespace understudy::vision
