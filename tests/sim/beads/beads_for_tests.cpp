#include "tests/sim/beads/beads_for_tests.h"
#include "core/random_vector.h"

#include <algorithm>
#include <cstdio>

namespace understudy::sim::test {
namespace {

std::array<float, 3> narrow(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}
Vec3 wide(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }

std::string numbers(std::initializer_list<double> values) {
  std::string text;
  for (const double v : values) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.17g", v);
    text += (text.empty() ? "" : ", ") + std::string(buffer);
  }
  return text;
}
std::string numbers(const std::array<float, 3>& v) { return "{" + numbers({v[0], v[1], v[2]}) + "}"; }

}  // namespace

Bead flat_bead(const Vec3& from, const Vec3& to, double width, double height) {
  Bead bead;
  bead.from_W = narrow(from);
  bead.to_W = narrow(to);
  bead.width = static_cast<float>(width);
  bead.height = static_cast<float>(height);
  return bead;
}

Bead round_bead(const Vec3& from, const Vec3& to, double diameter) {
  return flat_bead(from, to, diameter, diameter);
}

Bead moved(const Bead& bead, const Pose& X) {
  Bead result = bead;
  result.from_W = narrow(X * wide(bead.from_W));
  result.to_W = narrow(X * wide(bead.to_W));
  result.up_W = narrow(X.linear() * wide(bead.up_W));
  return result;
}

Vec3 random_vector(Random& random, double size) { return size * uniform_vec3(random, 1); }

std::vector<Bead> random_beads(Random& random, int count, double size) {
  std::vector<Bead> beads;
  for (int i = 0; i < count; ++i) {
    const double kind = random.uniform();
    const double length = kind < 0.1    ? 0
                          : kind < 0.15 ? random.uniform(0, 100e-3)
                                        : random.uniform(0.1e-3, 1e-3);
    const Vec3 from = random_vector(random, size), along = random_vector(random, 1).normalized();
    const double height = random.uniform(0.05e-3, 0.4e-3);
    const double width = random.uniform() < 0.3 ? height : height * random.uniform(1, 4);
    Bead bead = flat_bead(from, from + length * along, width, height);
    bead.up_W = narrow(random_vector(random, 1).normalized());
    bead.line = i;
    beads.push_back(bead);
  }
  return beads;
}

geometry::Shape random_shape(Random& random) {
  const auto size = [&](double low, double high) { return random.uniform(low * 1e-3, high * 1e-3); };
  geometry::Shape shape{"", geometry::Sphere{0}, Pose::Identity()};
  switch (random.bits() % 5) {
    case 0:
      shape.form = geometry::Sphere{size(0.05, 1)};
      break;
    case 1:
      shape.form = geometry::Capsule{size(0.05, 1), size(0.1, 3)};
      break;
    case 2:
      shape.form = geometry::Cylinder{size(0.1, 1), size(0.1, 3)};
      break;
    case 3:
      shape.form = geometry::Frustum{size(0.1, 0.5), size(0.5, 2), size(0.5, 3)};
      break;
    default:
      shape.form = geometry::Box{Vec3(size(0.1, 3), size(0.1, 3), size(0.1, 3))};
  }
  return shape;
}

ConvexSolid random_solid(Random& random) { return *convex_solid(random_shape(random)); }

std::string paste(const std::vector<Bead>& beads) {
  std::string text = "const std::vector<Bead> beads{\n";
  for (const Bead& b : beads) {
    text += "    {" + numbers(b.from_W) + ", " + numbers(b.to_W) + ", " + numbers(b.up_W) + ", " +
            numbers({b.width, b.height}) + "},\n";
  }
  return text + "};\n";
}

std::string paste(const Pose& X) {
  const Quat q(X.linear());
  const Vec3 p = X.translation();
  return "const Pose X = make_pose(Quat(" + numbers({q.w(), q.x(), q.y(), q.z()}) + "), Vec3(" +
         numbers({p.x(), p.y(), p.z()}) + "));\n";
}

std::string paste(const geometry::Shape& shape) {
  struct Form {
    std::string operator()(const geometry::Sphere& s) const { return "Sphere{" + numbers({s.radius}) + "}"; }
    std::string operator()(const geometry::Capsule& s) const {
      return "Capsule{" + numbers({s.radius, s.length}) + "}";
    }
    std::string operator()(const geometry::Cylinder& s) const {
      return "Cylinder{" + numbers({s.radius, s.length}) + "}";
    }
    std::string operator()(const geometry::Frustum& s) const {
      return "Frustum{" + numbers({s.radius_bottom, s.radius_top, s.height}) + "}";
    }
    std::string operator()(const geometry::Box& s) const {
      return "Box{Vec3(" + numbers({s.size.x(), s.size.y(), s.size.z()}) + ")}";
    }
    std::string operator()(const geometry::MeshShape&) const { return "MeshShape{}"; }
  };
  return "const geometry::Shape shape{\"\", geometry::" + std::visit(Form{}, shape.form) +
         ", Pose::Identity()};\n";
}

std::vector<Bead> zigzag(std::size_t count, double side, double shortest, double longest) {
  Random random(1, "zigzag");
  std::vector<Bead> beads;
  double x = 0, y = 0, z = 0.1e-3, way = 1;
  while (beads.size() < count) {
    const double end = std::clamp(x + way * random.uniform(shortest, longest), 0.0, side);
    beads.push_back(flat_bead(Vec3(x, y, z), Vec3(end, y, z)));
    x = end;
    if (x > 0 && x < side) continue;
    way = x > 0 ? -1 : 1;
    y += 0.4e-3;
    if (y <= side) continue;
    y = 0;
    z += 0.2e-3;
  }
  return beads;
}

}  // namespace understudy::sim::test
