#include "bench/beads/fcl_beads.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/narrowphase/distance.h>

namespace understudy::sim {
namespace {

constexpr double kScale = 1e3;  // FCL's tolerances want millimetres
constexpr int kCorners = 32;

std::shared_ptr<fcl::Convexd> polytope(const geometry::Frustum& f) {
  auto points = std::make_shared<std::vector<fcl::Vector3d>>();
  auto faces = std::make_shared<std::vector<int>>();
  for (const auto& [r, z] : {std::pair{f.radius_bottom, 0.0}, std::pair{f.radius_top, f.height}}) {
    for (int i = 0; i < kCorners; ++i) {
      const double angle = 2 * std::numbers::pi * i / kCorners;
      points->emplace_back(kScale * r * std::cos(angle), kScale * r * std::sin(angle), kScale * z);
    }
  }
  faces->push_back(kCorners);
  for (int i = kCorners - 1; i >= 0; --i) faces->push_back(i);
  faces->push_back(kCorners);
  for (int i = 0; i < kCorners; ++i) faces->push_back(kCorners + i);
  for (int i = 0; i < kCorners; ++i) {
    const int j = (i + 1) % kCorners;
    for (const int v : {4, i, j, kCorners + j, kCorners + i}) faces->push_back(v);
  }
  return std::make_shared<fcl::Convexd>(points, kCorners + 2, faces);
}

struct Answer {
  double least;  // [mm]
};

bool compare(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data, double& distance) {
  auto& answer = *static_cast<Answer*>(data);
  fcl::DistanceRequestd request;
  request.gjk_solver_type = fcl::GST_LIBCCD;
  fcl::DistanceResultd result;
  fcl::distance(a, b, request, result);
  answer.least = std::min(answer.least, result.min_distance);
  distance = answer.least;
  return distance <= 0;
}

}  // namespace

struct FclBeads::State {
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects;
  fcl::DynamicAABBTreeCollisionManagerd manager;
};

FclBeads::FclBeads(const std::vector<Bead>& beads) : state_(std::make_unique<State>()) {
  for (const Bead& bead : beads) {
    const Vec3 from(bead.from_W[0], bead.from_W[1], bead.from_W[2]),
        to(bead.to_W[0], bead.to_W[1], bead.to_W[2]);
    const auto shape = geometry::capsule_between("", from, to, 0.5 * static_cast<double>(bead.height));
    const auto& capsule = std::get<geometry::Capsule>(shape.form);
    fcl::Transform3d X = fcl::Transform3d::Identity();
    X.linear() = shape.X_FS.linear();
    X.translation() = kScale * shape.X_FS.translation();
    state_->objects.push_back(std::make_unique<fcl::CollisionObjectd>(
        std::make_shared<fcl::Capsuled>(kScale * capsule.radius, kScale * capsule.length), X));
  }
  std::vector<fcl::CollisionObjectd*> all;
  for (const auto& object : state_->objects) all.push_back(object.get());
  state_->manager.registerObjects(all);
  state_->manager.setup();
}

FclBeads::~FclBeads() = default;

double FclBeads::distance(const geometry::Frustum& solid, const Pose& X_WS, double cutoff) const {
  fcl::Transform3d X = fcl::Transform3d::Identity();
  X.linear() = X_WS.linear();
  X.translation() = kScale * X_WS.translation();
  fcl::CollisionObjectd object(polytope(solid), X);
  Answer answer{kScale * cutoff};
  state_->manager.distance(&object, &answer, compare);
  return answer.least / kScale;
}

}  // namespace understudy::sim
