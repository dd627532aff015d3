// Dense symmetric systems: factored in one file, so that those who solve one do not compile the solvers again.
//
//   const Eigen::VectorXd x = ldlt_solve(normal, rhs);          // normal x = rhs
//   const Cholesky factor(normal);
//   if (!factor.positive_definite()) return;
//   const Eigen::MatrixXd y = factor.solve(cross);              // normal y = cross
//   const SymmetricEigen e = symmetric_eigen(information);      // e.values ascending
//
// Law: A = P' L D L' P (LDLT, Golub, Van Loan 2013, 4.4), A = L L' (Cholesky, 4.2), A = V diag(values) V' (8.3).
// Validity: A symmetric, its lower triangle is read; for a few dozen unknowns, not for sparse systems.
#pragma once
#include <Eigen/Core>

namespace omnihil {

// A x = b; A p x p semidefinite, b of p.
Eigen::VectorXd ldlt_solve(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);
// A X = B; A p x p semidefinite, B p x c.
Eigen::MatrixXd ldlt_solve_columns(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

struct SymmetricEigen {
  Eigen::VectorXd values;   // p, ascending
  Eigen::MatrixXd vectors;  // p x p: of norm 1, as columns
};
SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& a);

class Cholesky {
 public:
  Cholesky() = default;
  explicit Cholesky(const Eigen::MatrixXd& a);

  bool positive_definite() const { return positive_definite_; }
  const Eigen::MatrixXd& lower() const { return lower_; }  // L: p x p, zero above the diagonal
  // L y = b, y of p.
  Eigen::VectorXd forward(const Eigen::VectorXd& b) const;
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;  // b p x c

 private:
  Eigen::MatrixXd lower_;
  bool positive_definite_ = false;
};

}  // namespace omnihil
