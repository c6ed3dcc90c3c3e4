#include "report/gltf/machine_nodes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <variant>

#include "renderer/tessellate.h"
#include "report/gltf/tracks.h"

namespace understudy::report {
namespace {

using rehearsal::ReplayBody;

constexpr int kSegments = 24;  // of round bodies

/// Viewers light a scene brighter than the pictures of a report.
LinearColour dimmed(const LinearColour& colour) {
  return {0.55f * colour[0], 0.55f * colour[1], 0.55f * colour[2]};
}

/// Corners that share place and normal are one vertex.
GltfTriangles triangles_of(const renderer::Surface& surface) {
  GltfTriangles result;
  std::map<std::array<float, 6>, int> numbers;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    std::array<int, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = surface.vertices[static_cast<std::size_t>(surface.triangles[t][k])];
      const Vec3& n = surface.corner_normals[t][k];
      std::array<float, 6> key{};
      for (std::size_t i = 0; i < 3; ++i) {
        key[i] = static_cast<float>(p[static_cast<int>(i)]);
        key[i + 3] = static_cast<float>(n[static_cast<int>(i)]);
      }
      const auto [entry, is_new] = numbers.try_emplace(key, static_cast<int>(result.places.size()));
      if (is_new) {
        result.places.push_back(p);
        result.normals.push_back(n);
      }
      corners[k] = entry->second;
    }
    if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0])
      result.triangles.push_back(corners);
  }
  return result;
}

GltfTriangles triangles_of(const geometry::Shape& shape) {
  return triangles_of(renderer::tessellate(shape, kSegments, renderer::Creases::left_out));
}

double reach_of(const GltfTriangles& triangles, const Pose& X) {
  double reach = 0;
  for (const Vec3& p : triangles.places) reach = std::max(reach, (X * p).norm());
  return reach;
}

/// Puts bodies into a scene, each where what carries it says.
class MachineNodes {
 public:
  MachineNodes(const RecordedReplay& replay, const MotionSettings& settings, const FrameNodes& frames,
               GltfScene& scene)
      : replay_(replay), settings_(settings), frames_(frames), scene_(scene) {
    for (const auto& point : replay.path) {
      times_.push_back(point.time);
      X_WT_.push_back(point.X_WT);
    }
  }

  void add_all() {
    for (const ReplayBody& body : replay_.machine.bodies) {
      if (body.carrier == ReplayBody::Carrier::tool) on_tool_.push_back(&body);
      if (body.carrier == ReplayBody::Carrier::strut) add_strut(body);
      if (body.carrier == ReplayBody::Carrier::world) add_still(body.shape, still_frame(), body.shape.X_FS);
      if (body.carrier == ReplayBody::Carrier::axes) add_moved(body);
    }
    add_tool();
    if (replay_.table)
      scene_.node("table", frames_.work, replay_.table->X_FS,
                  mesh("table", triangles_of(unposed(*replay_.table)), "table", dimmed(kTable)));
    if (replay_.part)
      scene_.node("part", frames_.work, Pose::Identity(),
                  mesh("part", triangles_of(renderer::tessellate(*replay_.part, renderer::Creases::left_out)),
                       "part", dimmed(kPart)));
  }

 private:
  /// What stands still in W belongs to the work only where axes move that.
  int still_frame() const { return replay_.machine.X_WO.empty() ? frames_.machine : frames_.work; }

  static geometry::Shape unposed(geometry::Shape shape) {
    shape.X_FS = Pose::Identity();
    return shape;
  }

  int mesh(const std::string& name, const GltfTriangles& triangles, const std::string& material,
           const LinearColour& colour) {
    return scene_.mesh(name, triangles, scene_.material(material, colour));
  }
  int body_mesh(const std::string& name, const GltfTriangles& triangles) {
    const LinearColour colour = colour_of_body(name);
    const char* material = colour == kStrut    ? "strut"
                           : colour == kBrass  ? "brass"
                           : colour == kHeater ? "heater"
                                               : "metal";
    return mesh(name, triangles, material, colour);
  }

  void add_still(const geometry::Shape& shape, int parent, const Pose& X) {
    scene_.node(shape.name, parent, X, body_mesh(shape.name, triangles_of(unposed(shape))));
  }

  Motion motion(double reach) const { return {settings_.within, settings_.speed, reach}; }

  /// Posed in the machine's frame, in which most bodies of such a machine stand still.
  void add_moved(const ReplayBody& body) {
    std::vector<Pose> poses = body.X_WF;
    for (std::size_t k = 0; k < replay_.machine.X_WO.size(); ++k)
      poses[k] = replay_.machine.X_WO[k].inverse(Eigen::Isometry) * poses[k];
    const GltfTriangles triangles = triangles_of(unposed(body.shape));
    const int node = add_moving_node(body.shape.name, frames_.machine, replay_.machine.key_times, poses,
                                     motion(reach_of(triangles, Pose::Identity())), scene_);
    scene_.set_mesh(node, body_mesh(body.shape.name, triangles));
  }

  void add_tool() {
    double reach = 0;
    std::vector<GltfTriangles> forms;
    for (const ReplayBody* body : on_tool_) {
      forms.push_back(triangles_of(unposed(body->shape)));
      reach = std::max(reach, reach_of(forms.back(), body->shape.X_FS));
    }
    const int tool = add_moving_node("tool", still_frame(), times_, X_WT_, motion(reach), scene_);
    for (std::size_t i = 0; i < on_tool_.size(); ++i)
      scene_.node(on_tool_[i]->shape.name, tool, on_tool_[i]->shape.X_FS,
                  body_mesh(on_tool_[i]->shape.name, forms[i]));
  }

  /// A joint that turns, below it a rod that is scaled to its length and a ball at its end.
  void add_strut(const ReplayBody& body) {
    const double radius = std::get<geometry::Capsule>(body.shape.form).radius;
    const std::string& name = body.shape.name;
    TurnTrack turns{times_, {}};
    PlaceTrack ends{times_, {}}, scales{times_, {}};
    Quat last = Quat::Identity();
    double longest = 0;
    for (const Pose& X_WT : X_WT_) {
      const Vec3 along = X_WT * body.to_T - body.from_W;
      // From the turn before: so it does not spin about itself.
      last = (Quat::FromTwoVectors(last * Vec3::UnitZ(), along) * last).normalized();
      turns.turns.push_back(last);
      ends.places.emplace_back(0, 0, along.norm());
      scales.places.emplace_back(1, 1, along.norm());
      longest = std::max(longest, along.norm());
    }
    const int joint = scene_.node(name, still_frame(), make_pose(turns.turns.back(), body.from_W),
                                  body_mesh(name + " joint", triangles_of({name, geometry::Sphere{radius}})));
    const Pose half = make_pose(Quat::Identity(), Vec3(0, 0, 0.5));
    const int rod =
        scene_.node(name + " rod", joint, Pose::Identity(),
                    body_mesh(name + " rod", triangles_of({name, geometry::Cylinder{radius, 1}, half})));
    scene_.set_scale(rod, scales.places.back());
    const int end = scene_.node(name + " end", joint, make_pose(Quat::Identity(), ends.places.back()),
                                body_mesh(name + " end", triangles_of({name, geometry::Sphere{radius}})));
    const double half_bound = settings_.within / 2;
    animate_turns(joint, std::move(turns), half_bound / std::max(longest + radius, 1e-6), settings_.speed,
                  scene_);
    scales = thinned(scales, half_bound);
    for (double& time : scales.times) time /= settings_.speed;
    scene_.animate_scale(rod, scales.times, scales.places);
    animate_places(end, std::move(ends), half_bound, settings_.speed, scene_);
  }

  const RecordedReplay& replay_;
  const MotionSettings& settings_;
  const FrameNodes& frames_;
  GltfScene& scene_;
  std::vector<double> times_;
  std::vector<Pose> X_WT_;
  std::vector<const ReplayBody*> on_tool_;
};

/// How far what is printed, table and part reach from W's origin.
double reach_of_work(const RecordedReplay& replay) {
  double reach = 0;
  if (replay.table) reach = reach_of(triangles_of(*replay.table), Pose::Identity());
  if (replay.part) reach = std::max({reach, replay.part->lower().norm(), replay.part->upper().norm()});
  for (const auto& point : replay.path) reach = std::max(reach, point.X_WT.translation().norm());
  return reach;
}

}  // namespace

FrameNodes add_frames(const RecordedReplay& replay, const MotionSettings& settings, int top,
                      GltfScene& scene) {
  FrameNodes frames;
  frames.machine = scene.node("machine", top);
  if (replay.machine.X_WO.empty()) {
    frames.work = scene.node("work", frames.machine);
    return frames;
  }
  std::vector<Pose> X_OW;
  for (const Pose& X_WO : replay.machine.X_WO) X_OW.push_back(X_WO.inverse(Eigen::Isometry));
  frames.work = add_moving_node("work", frames.machine, replay.machine.key_times, X_OW,
                                {settings.within, settings.speed, reach_of_work(replay)}, scene);
  return frames;
}

void add_machine(const RecordedReplay& replay, const MotionSettings& settings, const FrameNodes& frames,
                 GltfScene& scene) {
  MachineNodes(replay, settings, frames, scene).add_all();
}

}  // namespace understudy::report
