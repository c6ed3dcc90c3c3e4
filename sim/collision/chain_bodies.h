// The links of an open chain as rigid bodies in W, and how far each can move.
#pragma once

#include <vector>

#include "geometry/shape.h"
#include "sim/as_built/as_built.h"
#include "sim/collision/configuration.h"

namespace understudy::sim {

class ChainBodies {
 public:
  struct Item {
    geometry::Shape shape;  ///< X_FS in O with all axes at 0
    int axis = -1;          ///< that carries it; -1: the frame
    int rod = -1;           ///< of a rod: the axis whose slide it hangs on; X_FS then has no meaning
    double side = 0;        ///< [m], of a rod, from the middle of its pair
  };

  static constexpr int kOnRods = -2;  ///< in place of an axis: carried by all rods

  /// Empty for a machine that is no chain.
  ChainBodies(const machine::MachineDescription& machine, const AsBuilt& as_built);

  const std::vector<Item>& items() const { return items_; }
  /// Poses every link for these axes.
  void pose(const kinematics::AxisVector& axes);
  /// Of the shape's own frame, as last posed.
  Pose place(std::size_t item) const;
  /// The frame O of the machine, likewise: where axes move the table, it moves in W.
  const Pose& X_WO() const { return X_WO_; }
  /// [m], at most, by which any point of the item moves in W while each axis moves by at most `travel` and
  /// the tip by `path`.
  double motion(std::size_t item, const kinematics::AxisVector& travel, double path = 0) const;
  /// Whether the two are one body or meet in a joint, where nearness means nothing.
  bool joined(int axis, int other) const;
  /// kOnRods where no axis carries the tool.
  int tool_axis() const { return chain_.rods.empty() ? chain_.tool_axis : kOnRods; }
  int work_axis() const { return chain_.work_axis; }

 private:
  const kinematics::ChainAxis& axis(int i) const { return chain_.axes[static_cast<std::size_t>(i)]; }
  double reach_from(int axis, const Item& item) const;
  double way_to(int axis) const;
  void add_rods(const machine::Rods& rods);
  Pose rod_place(const Item& rod) const;

  kinematics::Chain chain_;
  kinematics::AxisVector zero_{};
  Pose X_WB_;
  std::vector<Item> items_;
  std::vector<kinematics::AxisVector> levers_;  ///< [m per unit], of each item against each axis
  std::vector<Pose> X_OL_;
  Pose X_WO_ = Pose::Identity();
  double tool_offset_ = 0;  ///< [m], of the rods' joints
  kinematics::AxisVector posed_{};
  Vec3 rods_meet_O_ = Vec3::Zero();
};

}  // namespace understudy::sim
