#include "calibration/rows/surroundings.h"

#include <algorithm>

namespace understudy::calibration {
namespace {

using Slot = SurroundingsLayout::Slot;

int index_of(std::vector<Slot>& slots, const std::string& name) {
  const auto found =
      std::find_if(slots.begin(), slots.end(), [&](const Slot& slot) { return slot.name == name; });
  if (found != slots.end()) return static_cast<int>(found - slots.begin());
  slots.push_back({name, -1, -1, false});
  return static_cast<int>(slots.size()) - 1;
}

bool has_position(RowKind kind) { return kind != RowKind::orientation; }
bool has_turn(RowKind kind) { return kind == RowKind::pose || kind == RowKind::orientation; }

Slot& slot_at(std::vector<Slot>& slots, int index) { return slots[static_cast<std::size_t>(index)]; }

/// Gives columns to the unknown numbers of one row after the other.
class ColumnTaker {
 public:
  ColumnTaker(const RowProblem& problem, SurroundingsLayout& layout) : problem_(problem), layout_(layout) {}

  SurroundingsLayout::Use take(const MeasurementRow& row);

 private:
  void take(Eigen::Index& column, const std::string& name, std::initializer_list<const char*> numbers) {
    if (column >= 0) return;
    column = layout_.columns();
    for (const char* number : numbers) layout_.names.push_back(name + " " + number);
  }
  void take_pose(Slot& slot, const std::string& name, RowKind kind) {
    if (slot.known) return;
    if (has_turn(kind) || name.starts_with("frame")) take(slot.turn, name, {"turn x", "turn y", "turn z"});
    if (has_position(kind)) take(slot.position, name, {"x", "y", "z"});
  }
  int take_place(const MeasurementRow& row);

  const RowProblem& problem_;
  SurroundingsLayout& layout_;
};

SurroundingsLayout::Use ColumnTaker::take(const MeasurementRow& row) {
  SurroundingsLayout::Use use;
  use.target = index_of(layout_.targets, row.target);
  Slot& target = slot_at(layout_.targets, use.target);
  target.known = row.target.empty() || problem_.targets.contains(row.target);
  take_pose(target, "target " + row.target, row.kind);
  if (row.kind == RowKind::distance || row.kind == RowKind::point || row.kind == RowKind::plane) {
    use.place = take_place(row);
    return use;
  }
  use.frame = index_of(layout_.frames, row.frame);
  Slot& frame = slot_at(layout_.frames, use.frame);
  frame.known = row.frame.empty() || problem_.frames.contains(row.frame);
  take_pose(frame, "frame " + row.frame, row.kind);
  return use;
}

int ColumnTaker::take_place(const MeasurementRow& row) {
  const bool anchor = row.kind == RowKind::distance, plane = row.kind == RowKind::plane;
  auto& slots = anchor ? layout_.anchors : plane ? layout_.planes : layout_.points;
  const int index = index_of(slots, row.place);
  Slot& slot = slot_at(slots, index);
  slot.known = anchor  ? problem_.anchors.contains(row.place)
               : plane ? problem_.planes.contains(row.place)
                       : problem_.points.contains(row.place);
  const std::string name = (anchor ? "anchor " : plane ? "plane " : "point ") + row.place;
  if (!slot.known && plane) take(slot.position, name, {"tilt u", "tilt v", "offset"});
  if (!slot.known && !plane) take(slot.position, name, {"x", "y", "z"});
  if (anchor && problem_.with_zero.contains(row.place)) take(slot.turn, name, {"zero"});
  return index;
}

}  // namespace

const char* to_string(RowKind kind) {
  switch (kind) {
    case RowKind::pose:
      return "pose";
    case RowKind::position:
      return "position";
    case RowKind::orientation:
      return "orientation";
    case RowKind::distance:
      return "distance";
    case RowKind::point:
      return "point";
    case RowKind::plane:
      break;
  }
  return "plane";
}

int equations_of(RowKind kind) {
  if (kind == RowKind::pose) return 6;
  return kind == RowKind::distance || kind == RowKind::plane ? 1 : 3;
}

SurroundingsLayout::SurroundingsLayout(const RowProblem& problem) {
  ColumnTaker taker(problem, *this);
  for (const MeasurementRow& row : problem.rows) rows.push_back(taker.take(row));
  for (const KnownDistance& d : problem.distances) {
    const int a = index_of(points, d.a), b = index_of(points, d.b);
    distances.emplace_back(a, b);
  }
}

Surroundings SurroundingsLayout::known(const RowProblem& problem) const {
  Surroundings at;
  const auto fill = [](const std::vector<Slot>& slots, const auto& known_ones, const auto& unknown,
                       auto& values) {
    for (const Slot& slot : slots) {
      const auto found = known_ones.find(slot.name);
      values.push_back(found == known_ones.end() ? unknown : found->second);
    }
  };
  const Pose nowhere = Pose::Identity();
  const Vec3 origin = Vec3::Zero();
  fill(frames, problem.frames, nowhere, at.frames);
  fill(targets, problem.targets, nowhere, at.targets);
  fill(points, problem.points, origin, at.points);
  fill(anchors, problem.anchors, origin, at.anchors);
  fill(anchors, problem.zeros, 0.0, at.zeros);
  fill(planes, problem.planes, Plane{}, at.planes);
  return at;
}

std::pair<Vec3, Vec3> across(const Vec3& normal) {
  const Vec3 u = normal.unitOrthogonal();
  return {u, normal.cross(u)};
}

Surroundings moved(const Surroundings& from, const SurroundingsLayout& layout, const Eigen::VectorXd& by) {
  Surroundings to = from;
  const auto three = [&](Eigen::Index column) {
    return column < 0 ? Vec3(Vec3::Zero()) : Vec3(by.segment<3>(column));
  };
  for (std::size_t i = 0; i < to.frames.size(); ++i) {
    const Slot& slot = layout.frames[i];
    to.frames[i] = make_pose(Mat3(exp_rotation(three(slot.turn)) * from.frames[i].linear()),
                             from.frames[i].translation() + three(slot.position));
  }
  for (std::size_t i = 0; i < to.targets.size(); ++i) {
    const Slot& slot = layout.targets[i];
    to.targets[i] = make_pose(Mat3(from.targets[i].linear() * exp_rotation(three(slot.turn))),
                              from.targets[i].translation() + three(slot.position));
  }
  for (std::size_t i = 0; i < to.points.size(); ++i) to.points[i] += three(layout.points[i].position);
  for (std::size_t i = 0; i < to.anchors.size(); ++i) {
    to.anchors[i] += three(layout.anchors[i].position);
    if (layout.anchors[i].turn >= 0) to.zeros[i] += by[layout.anchors[i].turn];
  }
  for (std::size_t i = 0; i < to.planes.size(); ++i) {
    const auto [u, v] = across(from.planes[i].normal);
    const Vec3 d = three(layout.planes[i].position);
    to.planes[i].normal = (exp_rotation(d.x() * u + d.y() * v) * from.planes[i].normal).normalized();
    to.planes[i].offset += d.z();
  }
  return to;
}

}  // namespace understudy::calibration
