#include "sim/law/symmetric.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace omnihil {

Eigen::VectorXd ldlt_solve(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) { return a.ldlt().solve(b); }

Eigen::MatrixXd ldlt_solve_columns(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.ldlt().solve(b);
}

SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& a) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(a);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Cholesky::Cholesky(const Eigen::MatrixXd& a) {
  const Eigen::LLT<Eigen::MatrixXd> factor(a);
  positive_definite_ = factor.info() == Eigen::Success;
  lower_ = factor.matrixL();
}

Eigen::VectorXd Cholesky::forward(const Eigen::VectorXd& b) const {
  return lower_.triangularView<Eigen::Lower>().solve(b);
}

Eigen::VectorXd Cholesky::solve(const Eigen::VectorXd& b) const {
  return lower_.triangularView<Eigen::Lower>().adjoint().solve(forward(b));
}

Eigen::MatrixXd Cholesky::solve(const Eigen::MatrixXd& b) const {
  Eigen::MatrixXd x = b;
  lower_.triangularView<Eigen::Lower>().solveInPlace(x);
  lower_.triangularView<Eigen::Lower>().adjoint().solveInPlace(x);
  return x;
}

}  // namespace omnihil
