// Closed forms: a system with a known answer, one that is not positive definite, a rotation's eigenvectors.
#include "sim/law/symmetric.h"

#include <gtest/gtest.h>

#include <cmath>

namespace omnihil {
namespace {

Eigen::MatrixXd example() {
  Eigen::MatrixXd a(3, 3);
  a << 4, 2, 0, 2, 5, 3, 0, 3, 6;
  return a;
}

TEST(Symmetric, LdltSolvesForOneColumnAndForSeveral) {
  const Eigen::Vector3d x(1, -2, 3);
  const Eigen::VectorXd b = example() * x;  // (0, 1, 12)
  EXPECT_TRUE(ldlt_solve(example(), b).isApprox(x, 1e-14));
  EXPECT_TRUE(ldlt_solve_columns(example(), example()).isApprox(Eigen::MatrixXd::Identity(3, 3), 1e-14));
}

TEST(Symmetric, EigenvaluesOfATurnedDiagonalAscend) {
  const double c = std::cos(0.3), s = std::sin(0.3);
  Eigen::MatrixXd v(2, 2);
  v << c, -s, s, c;
  const SymmetricEigen e = symmetric_eigen(v * Eigen::Vector2d(7, 2).asDiagonal() * v.transpose());
  EXPECT_NEAR(e.values(0), 2, 1e-14);
  EXPECT_NEAR(e.values(1), 7, 1e-14);
  EXPECT_NEAR(std::abs(e.vectors.col(1).dot(v.col(0))), 1, 1e-14);
}

TEST(Symmetric, CholeskySolvesAndRebuildsItsMatrix) {
  const Cholesky factor(example());
  ASSERT_TRUE(factor.positive_definite());
  EXPECT_TRUE((factor.lower() * factor.lower().transpose()).isApprox(example(), 1e-14));
  EXPECT_EQ(factor.lower()(0, 2), 0);
  const Eigen::VectorXd x = Eigen::Vector3d(1, -2, 3), b = example() * x;
  EXPECT_TRUE(factor.solve(b).isApprox(x, 1e-14));
  EXPECT_TRUE((factor.lower() * factor.forward(b)).isApprox(b, 1e-14));
  EXPECT_TRUE(factor.solve(example()).isApprox(Eigen::MatrixXd::Identity(3, 3), 1e-14));
}

TEST(Symmetric, CholeskySaysWhatIsIndefinite) {
  Eigen::MatrixXd a(2, 2);
  a << 1, 2, 2, 1;  // eigenvalues -1 and 3
  EXPECT_FALSE(Cholesky(a).positive_definite());
}

}  // namespace
}  // namespace omnihil
