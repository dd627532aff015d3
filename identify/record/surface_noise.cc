#include "identify/record/surface_noise.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "identify/record/statistics.h"

namespace omnihil {

double surface_noise(const std::vector<double>& y, const std::vector<std::vector<double>>& of) {
  constexpr std::size_t kRowsPerNumber = 5;  // the factor for those fitted is then 1.12 at most; a choice
  constexpr double kRankThreshold = 1e-9;    // of the columns, scaled to one: what doubles resolve; a choice
  std::vector<std::size_t> rows;
  for (std::size_t k = 0; k < y.size(); ++k) {
    const auto known = [&](const std::vector<double>& x) { return std::isfinite(x[k]); };
    if (known(y) && std::all_of(of.begin(), of.end(), known)) rows.push_back(k);
  }
  const std::size_t columns = 1 + 3 * of.size() + of.size() * (of.size() - 1) / 2;
  const auto n = static_cast<Eigen::Index>(rows.size());
  if (rows.size() < columns) return std::numeric_limits<double>::infinity();
  Eigen::MatrixXd a(n, static_cast<Eigen::Index>(columns));
  Eigen::VectorXd b(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::size_t k = rows[static_cast<std::size_t>(i)];
    Eigen::Index c = 0;
    b[i] = y[k];
    a(i, c++) = 1.0;
    for (std::size_t j = 0; j < of.size(); ++j) {
      const double x = of[j][k];
      a(i, c++) = x;
      a(i, c++) = std::abs(x) * x;
      a(i, c++) = x == 0.0 ? 0.0 : std::copysign(1.0, x);
      for (std::size_t l = 0; l < j; ++l) a(i, c++) = x * of[l][k];
    }
  }
  for (Eigen::Index c = 0; c < a.cols(); ++c) {
    if (const double size = a.col(c).norm(); size > 0.0) a.col(c) /= size;
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
  qr.setThreshold(kRankThreshold);
  qr.compute(a);
  const auto numbers = static_cast<std::size_t>(qr.rank());
  if (rows.size() < kRowsPerNumber * numbers) return std::numeric_limits<double>::infinity();
  const Eigen::VectorXd rest = b - a * qr.solve(b);
  std::vector<double> sizes;
  for (const double r : rest) sizes.push_back(std::abs(r));
  const double count = static_cast<double>(rows.size());
  return sigma_by_mad(std::move(sizes)) * std::sqrt(count / (count - static_cast<double>(numbers)));
}

double command_slope(const std::vector<double>& command, const std::vector<double>& velocity) {
  double n = 0.0, u = 0.0, w = 0.0, uw = 0.0, ww = 0.0;
  for (std::size_t k = 0; k < command.size() && k < velocity.size(); ++k) {
    if (!std::isfinite(command[k]) || !std::isfinite(velocity[k]) || velocity[k] == 0.0) continue;
    n += 1.0, u += command[k], w += velocity[k], uw += command[k] * velocity[k],
        ww += velocity[k] * velocity[k];
  }
  const double spread = ww - w * w / std::max(n, 1.0);
  return spread > 0.0 ? (uw - u * w / n) / spread : 0.0;
}

double command_noise(const std::vector<double>& command, const std::vector<double>& velocity) {
  constexpr std::size_t kLeastPairs = 20;  // the sigma is then known to a quarter: 1.17 / sqrt(20); a choice
  std::map<double, double> last;           // command: speed of its last row
  std::vector<double> differences;
  for (std::size_t k = 0; k < command.size() && k < velocity.size(); ++k) {
    if (!std::isfinite(command[k]) || !std::isfinite(velocity[k]) || velocity[k] == 0.0) continue;
    const auto [at, is_first] = last.try_emplace(command[k], velocity[k]);
    if (!is_first) differences.push_back(std::abs(velocity[k] - at->second));
    at->second = velocity[k];
  }
  if (differences.size() < kLeastPairs) return std::numeric_limits<double>::infinity();
  return sigma_by_mad(std::move(differences)) / std::sqrt(2.0) * std::abs(command_slope(command, velocity));
}

}  // namespace omnihil
