#include "sim/plant/bullet/bullet_tree.h"

#include <Eigen/Eigenvalues>

namespace understudy::sim {
namespace {

// Bullet damps every body by 4 % a second unless told otherwise, and caps speeds at 100.
void make_ideal(btMultiBody& body) {
  body.setLinearDamping(0);
  body.setAngularDamping(0);
  body.setCanSleep(false);
  body.setMaxCoordinateVelocity(1e6);
}

struct PrincipalFrame {
  Mat3 R_FL;
  Vec3 moments;
};

PrincipalFrame principal_frame(const Mat3& inertia_F) {
  const Mat3 off_diagonal = inertia_F - Mat3(inertia_F.diagonal().asDiagonal());
  if (off_diagonal.isZero(0)) return {Mat3::Identity(), inertia_F.diagonal()};
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(inertia_F);
  Mat3 R = solver.eigenvectors();
  if (R.determinant() < 0) R.col(2) = -R.col(2);
  return {R, solver.eigenvalues()};
}

}  // namespace

std::unique_ptr<btMultiBody> make_tree(const std::vector<BulletLink>& links, const Pose& X_WF) {
  auto tree =
      std::make_unique<btMultiBody>(static_cast<int>(links.size()), 0.0, btVector3(0, 0, 0), true, false);
  tree->setBaseWorldTransform(
      btTransform(to_bullet(Quat(X_WF.linear())), to_bullet(Vec3(X_WF.translation()))));
  std::vector<Pose> X_FL;
  for (std::size_t i = 0; i < links.size(); ++i) {
    const BulletLink& link = links[i];
    const PrincipalFrame own = principal_frame(link.inertia_F);
    const Pose X_FP = link.parent < 0 ? Pose::Identity() : X_FL[static_cast<std::size_t>(link.parent)];
    X_FL.push_back(make_pose(own.R_FL, link.centre_F));
    const Pose X_LP = X_FL.back().inverse() * X_FP;
    const btQuaternion R_LP = to_bullet(Quat(X_LP.linear()).normalized());
    const btVector3 axis_L = to_bullet(Vec3(own.R_FL.transpose() * link.axis_F)),
                    moments = to_bullet(own.moments);
    const Vec3 pivot_F = link.angle ? link.point_F : link.centre_F;
    const btVector3 pivot_P = to_bullet(Vec3(X_FP.inverse() * pivot_F)),
                    centre_L = to_bullet(Vec3(own.R_FL.transpose() * (link.centre_F - pivot_F)));
    const int index = static_cast<int>(i);
    if (link.angle)
      tree->setupRevolute(index, link.mass, moments, link.parent, R_LP, axis_L, pivot_P, centre_L, true);
    else
      tree->setupPrismatic(index, link.mass, moments, link.parent, R_LP, axis_L, pivot_P, centre_L, true);
  }
  tree->finalizeMultiDof();
  make_ideal(*tree);
  return tree;
}

std::unique_ptr<btMultiBody> make_floating_body(double mass, const Vec3& moments, const Pose& X_WC) {
  auto body = std::make_unique<btMultiBody>(0, mass, to_bullet(moments), false, false);
  body->setBaseWorldTransform(
      btTransform(to_bullet(Quat(X_WC.linear())), to_bullet(Vec3(X_WC.translation()))));
  body->finalizeMultiDof();
  make_ideal(*body);
  return body;
}

Pose link_pose(const btMultiBody& tree, int link) {
  if (link < 0)
    return make_pose(from_bullet(tree.getWorldToBaseRot()).conjugate().normalized(),
                     from_bullet(tree.getBasePos()));
  const Pose X_WP = link_pose(tree, tree.getParent(link));
  const Quat R_LP = from_bullet(tree.getParentToLocalRot(link));
  const Mat3 R_WL = X_WP.linear() * R_LP.conjugate().normalized().toRotationMatrix();
  return make_pose(R_WL, Vec3(X_WP.translation() + R_WL * from_bullet(tree.getRVector(link))));
}

}  // namespace understudy::sim
