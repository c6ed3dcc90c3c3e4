#include <algorithm>
#include <cmath>

#include "core/random_vector.h"
#include "vision/boards/view_ray_models.h"

namespace understudy::vision {
namespace {

/// The database of one layer: pixel and place of every corner (Song 2015, appendix B.1).
struct LayerTable {
  std::vector<Vec2> pixel;
  std::vector<Vec3> p_W;
};

struct Cell {
  int column, row;  // of its upper left corner
  double a, b;      // in 0..1 inside
};

class LayerViewRays : public ViewRayModel {
 public:
  LayerViewRays(const CameraLayers& layers, const CalibrationUncertainty& uncertainty, bool straight);
  ViewRay view_ray(const Vec2& pixel, int replica) const override;
  int replicas() const override { return static_cast<int>(databases_.size()) - 1; }

 private:
  Cell find_cell(const LayerTable& table, const Vec2& pixel) const;
  Vec3 place(const LayerTable& table, const Vec2& pixel) const;
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row * board_.columns + column);
  }

  Board board_;
  bool straight_;
  std::vector<std::vector<LayerTable>> databases_;  // as calibrated, then the replicas
};

LayerTable table_of(const Board& board, const BoardLayer& layer, const BoardPlacement& placement) {
  LayerTable table{layer.corners_px, {}};
  for (int r = 0; r < board.rows; ++r) {
    for (int c = 0; c < board.columns; ++c)
      table.p_W.push_back(layer.X_WG * placement.moved(board.corner(c, r)));
  }
  return table;
}

LayerViewRays::LayerViewRays(const CameraLayers& layers, const CalibrationUncertainty& uncertainty,
                             bool straight)
    : board_(layers.board), straight_(straight) {
  Random random(uncertainty.seed, "camera calibration replicas");
  for (int replica = -1; replica < uncertainty.replicas; ++replica) {
    std::vector<LayerTable> database;
    for (const BoardLayer& layer : layers.layers) {
      if (replica < 0) {
        database.push_back(table_of(board_, layer, {}));
        continue;
      }
      database.push_back(table_of(board_, layer, sample_placement(uncertainty.boards, random)));
      for (Vec2& p : database.back().pixel) p += uncertainty.corner_px * normal_vec2(random);
    }
    databases_.push_back(std::move(database));
  }
}

/// Walks from cell to cell towards the pixel, each step the inverse of the cell's bilinear map. A pixel
/// outside of the grid belongs to the nearest cell, continued.
Cell LayerViewRays::find_cell(const LayerTable& table, const Vec2& pixel) const {
  Cell cell{(board_.columns - 1) / 2, (board_.rows - 1) / 2, 0.5, 0.5};
  for (int step = 0; step < 2 * (board_.columns + board_.rows); ++step) {
    const Vec2& p00 = table.pixel[index(cell.column, cell.row)];
    const Vec2 p10 = table.pixel[index(cell.column + 1, cell.row)] - p00;
    const Vec2 p01 = table.pixel[index(cell.column, cell.row + 1)] - p00;
    const Vec2 twist = table.pixel[index(cell.column + 1, cell.row + 1)] - p00 - p10 - p01;
    cell.a = cell.b = 0.5;
    for (int i = 0; i < 8; ++i) {
      const Vec2 miss = p00 + cell.a * p10 + cell.b * p01 + cell.a * cell.b * twist - pixel;
      const Vec2 da = p10 + cell.b * twist, db = p01 + cell.a * twist;
      const double area = da.x() * db.y() - da.y() * db.x();
      if (!(std::abs(area) > 1e-9)) break;
      const double step_a = (miss.x() * db.y() - miss.y() * db.x()) / area;
      const double step_b = (da.x() * miss.y() - da.y() * miss.x()) / area;
      cell.a -= step_a;
      cell.b -= step_b;
      if (std::abs(step_a) + std::abs(step_b) < 1e-12) break;
    }
    const auto moved = [](int at, double share, int cells) {
      const double to = std::clamp(at + std::floor(share), 0.0, cells - 1.0);
      return static_cast<int>(to);
    };
    const int column = moved(cell.column, cell.a, board_.columns - 1);
    const int row = moved(cell.row, cell.b, board_.rows - 1);
    if (column == cell.column && row == cell.row) break;
    cell.column = column;
    cell.row = row;
  }
  return cell;
}

Vec3 LayerViewRays::place(const LayerTable& table, const Vec2& pixel) const {
  const Cell c = find_cell(table, pixel);
  return (1 - c.b) *
             ((1 - c.a) * table.p_W[index(c.column, c.row)] + c.a * table.p_W[index(c.column + 1, c.row)]) +
         c.b * ((1 - c.a) * table.p_W[index(c.column, c.row + 1)] +
                c.a * table.p_W[index(c.column + 1, c.row + 1)]);
}

/// Least squares over the position along the chord, whose errors hardly matter.
ViewRay straightened(const ViewRay& ray) {
  const Vec3 chord = (ray.points.back() - ray.points.front()).normalized();
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : ray.points) mean += p / static_cast<double>(ray.points.size());
  Vec3 slope = Vec3::Zero();
  double squares = 0;
  for (const Vec3& p : ray.points) {
    const double along = chord.dot(p - mean);
    slope += along * (p - mean);
    squares += along * along;
  }
  slope /= squares;
  return {{mean + chord.dot(ray.points.front() - mean) * slope,
           mean + chord.dot(ray.points.back() - mean) * slope}};
}

ViewRay LayerViewRays::view_ray(const Vec2& pixel, int replica) const {
  ViewRay ray;
  for (const LayerTable& table : databases_[static_cast<std::size_t>(replica + 1)]) {
    ray.points.push_back(place(table, pixel));
  }
  return straight_ ? straightened(ray) : ray;
}

}  // namespace

std::shared_ptr<const ViewRayModel> calibrate_layers(const CameraLayers& layers,
                                                     const CalibrationUncertainty& uncertainty,
                                                     bool straight) {
  return std::make_shared<LayerViewRays>(layers, uncertainty, straight);
}

}  // namespace understudy::vision
