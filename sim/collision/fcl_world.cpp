#include "sim/collision/fcl_world.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <functional>
#include <map>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/distance.h>

#include "core/error.h"
#include "geometry/mesh.h"

namespace understudy::sim {
namespace {

// FCL's tolerances are absolute and meant for shapes of size one: its world is in millimetres.
constexpr double kScale = 1e3;
// GJK on polytopes ends exactly; a smaller step than this is rounding.
constexpr double kProgressTolerance = 1e-8;  // [mm]

using Geometry = std::shared_ptr<fcl::CollisionGeometryd>;

struct Body {
  Geometry geometry;
  double radius = 0;                 // [mm], added around the core
  fcl::Capsuled* capsule = nullptr;  // its length may change
  Vec3 centre{0, 0, 0};              // [mm], of the geometry in the shape's frame
  bool is_mesh = false;
};

// Corners so that the polygon's radius is off by at most 0.25 um to either side of the circle.
int corners(double radius) {
  const double n = std::numbers::pi * std::sqrt(radius / 0.25e-3 / 4);
  return std::clamp(static_cast<int>(std::ceil(n)), 24, 160);
}

Geometry polytope(double bottom, double top, double z0, double z1) {
  const int n = corners(std::max(bottom, top));
  const double step = 2 * std::numbers::pi / n;
  // Between the inscribed and the circumscribed polygon.
  const double grow = 0.5 * (1 + 1 / std::cos(step / 2));
  auto points = std::make_shared<std::vector<fcl::Vector3d>>();
  auto faces = std::make_shared<std::vector<int>>();
  constexpr double kApex = 1e-6;  // a cone's tip keeps its faces
  for (const auto& [r, z] : {std::pair{bottom, z0}, std::pair{top, z1}}) {
    const double radius = std::max(r, kApex) * grow;
    for (int i = 0; i < n; ++i)
      points->emplace_back(radius * std::cos(i * step), radius * std::sin(i * step), z);
  }
  faces->push_back(n);
  for (int i = n - 1; i >= 0; --i) faces->push_back(i);
  faces->push_back(n);
  for (int i = 0; i < n; ++i) faces->push_back(n + i);
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    for (const int v : {4, i, j, n + j, n + i}) faces->push_back(v);
  }
  return std::make_shared<fcl::Convexd>(points, n + 2, faces);
}

// The mesh has a copy of a vertex for each of its smooth sides; FCL walks from vertex to neighbour and must
// know them as one.
Geometry hull(const geometry::Mesh& mesh) {
  auto points = std::make_shared<std::vector<fcl::Vector3d>>();
  auto faces = std::make_shared<std::vector<int>>();
  std::map<std::array<double, 3>, int> known;
  std::vector<int> index;
  for (const Vec3& v : mesh.vertices()) {
    const auto [place, is_new] =
        known.emplace(std::array{v.x(), v.y(), v.z()}, static_cast<int>(points->size()));
    if (is_new) points->push_back(v * kScale);
    index.push_back(place->second);
  }
  for (const auto& t : mesh.triangles()) {
    faces->push_back(3);
    for (const int corner : t) faces->push_back(index[static_cast<std::size_t>(corner)]);
  }
  return std::make_shared<fcl::Convexd>(points, static_cast<int>(mesh.triangles().size()), faces);
}

struct Convert {
  Body operator()(const geometry::Sphere& s) const {
    return {std::make_shared<fcl::Sphered>(0.0), s.radius * kScale, nullptr, Vec3::Zero(), false};
  }
  Body operator()(const geometry::Capsule& s) const {
    const auto capsule = std::make_shared<fcl::Capsuled>(0.0, s.length * kScale);
    return {capsule, s.radius * kScale, capsule.get(), Vec3::Zero(), false};
  }
  Body operator()(const geometry::Cylinder& s) const {
    const double r = s.radius * kScale, h = s.length * kScale / 2;
    return {polytope(r, r, -h, h), 0, nullptr, Vec3::Zero(), false};
  }
  Body operator()(const geometry::Frustum& s) const {
    const double h = s.height * kScale / 2;
    return {polytope(s.radius_bottom * kScale, s.radius_top * kScale, -h, h), 0, nullptr, Vec3(0, 0, h),
            false};
  }
  Body operator()(const geometry::Box& s) const {
    return {std::make_shared<fcl::Boxd>(s.size * kScale), 0, nullptr, Vec3::Zero(), false};
  }
  Body operator()(const geometry::MeshShape& s) const {
    auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
    std::vector<fcl::Vector3d> vertices;
    for (const Vec3& v : s.mesh->vertices()) vertices.push_back(v * kScale);
    std::vector<fcl::Triangle> triangles;
    for (const auto& t : s.mesh->triangles()) {
      triangles.emplace_back(static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1]),
                             static_cast<std::size_t>(t[2]));
    }
    model->beginModel(static_cast<int>(triangles.size()), static_cast<int>(vertices.size()));
    model->addSubModel(vertices, triangles);
    model->endModel();
    return {model, 0, nullptr, Vec3::Zero(), true};
  }
};

fcl::Transform3d pose_of(const Body& body, const Pose& X_W) {
  fcl::Transform3d X = fcl::Transform3d::Identity();
  X.linear() = X_W.linear();
  X.translation() = X_W.translation() * kScale + X_W.linear() * body.centre;
  return X;
}

Separation measure(const Body& a, const Pose& X_Wa, const Body& b, const Pose& X_Wb, bool obstacle_first) {
  // Signed distance would abort on meshes; the unsigned one is 0 or -1 where the cores overlap.
  fcl::DistanceRequestd request(true, false);
  request.distance_tolerance = kProgressTolerance;
  request.gjk_solver_type = fcl::GST_LIBCCD;
  fcl::DistanceResultd result;
  try {
    fcl::distance(a.geometry.get(), pose_of(a, X_Wa), b.geometry.get(), pose_of(b, X_Wb), request, result);
  } catch (const std::exception& e) {
    throw MachineError(std::string("FCL finds no distance: ") + e.what());
  }
  const double core = std::max(result.min_distance, 0.0);
  Separation separation;
  separation.distance = (core - a.radius - b.radius) / kScale;
  const Vec3 p = result.nearest_points[obstacle_first ? 0 : 1];
  const Vec3 towards = result.nearest_points[obstacle_first ? 1 : 0] - p;
  const double radius = obstacle_first ? a.radius : b.radius, length = towards.norm();
  separation.place_W = (length > 0 ? Vec3(p + towards * (radius / length)) : p) / kScale;
  return separation;
}

}  // namespace

struct FclWorld::State {
  // Built when it is first asked for: the hierarchy over a part's triangles takes long, and bodies that
  // another distance serves (BodySet) never ask.
  struct Item {
    std::function<Body()> make;
    std::optional<Body> made;
  };
  std::vector<Item> items;

  const Body& body(int index) {
    Item& item = items[index];
    if (!item.made) item.made = item.make();
    return *item.made;
  }
  int add(std::function<Body()> make) {
    items.push_back({std::move(make), {}});
    return static_cast<int>(items.size()) - 1;
  }
};

FclWorld::FclWorld() : state_(std::make_unique<State>()) {}
FclWorld::~FclWorld() = default;

int FclWorld::add(const geometry::Shape& shape) {
  return state_->add([form = shape.form] { return std::visit(Convert{}, form); });
}

int FclWorld::add_hull(std::shared_ptr<const geometry::Mesh> mesh) {
  return state_->add([mesh = std::move(mesh)] { return Body{hull(*mesh), 0, nullptr, Vec3::Zero(), false}; });
}

void FclWorld::set_capsule_length(int index, double length) {
  state_->body(index).capsule->lz = length * kScale;
}

Separation FclWorld::distance(int first, const Pose& X_W1, int second, const Pose& X_W2) const {
  const Body& a = state_->body(first);
  const Body& b = state_->body(second);
  // FCL turns a shape and a mesh round inside, but not the points it answers.
  if (b.is_mesh && !a.is_mesh) return measure(b, X_W2, a, X_W1, true);
  return measure(a, X_W1, b, X_W2, false);
}

}  // namespace understudy::sim
