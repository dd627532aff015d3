#include "identify/record/surface_noise.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "identify/record/statistics.h"

namespace omnihil {

namespace {

// Of the rows that are known, a surface's columns scaled to one: 1, and of each variable x, sgn x; if it is curved |x| x and the
// products as well.
Eigen::MatrixXd surface(const std::vector<std::vector<double>>& of, const std::vector<std::size_t>& rows,
                        bool is_curved) {
  std::vector<Eigen::VectorXd> columns{Eigen::VectorXd::Ones(static_cast<Eigen::Index>(rows.size()))};
  const auto add = [&](const auto& value) {
    Eigen::VectorXd column(static_cast<Eigen::Index>(rows.size()));
    for (std::size_t i = 0; i < rows.size(); ++i) column[static_cast<Eigen::Index>(i)] = value(rows[i]);
    if (const double size = column.norm(); size > 0.0) column /= size;
    columns.push_back(std::move(column));
  };
  for (std::size_t j = 0; j < of.size(); ++j) {
    const std::vector<double>& x = of[j];
    add([&](std::size_t k) { return x[k]; });
    add([&](std::size_t k) { return x[k] == 0.0 ? 0.0 : std::copysign(1.0, x[k]); });
    if (!is_curved) continue;
    add([&](std::size_t k) { return std::abs(x[k]) * x[k]; });
    for (std::size_t l = 0; l < j; ++l) add([&](std::size_t k) { return x[k] * of[l][k]; });
  }
  Eigen::MatrixXd a(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t c = 0; c < columns.size(); ++c) a.col(static_cast<Eigen::Index>(c)) = columns[c];
  return a;
}

}  // namespace

double surface_noise(const std::vector<double>& y, const std::vector<std::vector<double>>& of) {
  constexpr std::size_t kRowsPerNumber = 5;  // the factor for those fitted is then 1.12 at most; a choice
  constexpr double kRankThreshold = 1e-9;    // of the columns, scaled to one: what doubles resolve; a choice
  std::vector<std::size_t> rows;
  for (std::size_t k = 0; k < y.size(); ++k) {
    const auto known = [&](const std::vector<double>& x) { return std::isfinite(x[k]); };
    if (known(y) && std::all_of(of.begin(), of.end(), known)) rows.push_back(k);
  }
  Eigen::VectorXd b(static_cast<Eigen::Index>(rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) b[static_cast<Eigen::Index>(i)] = y[rows[i]];
  for (const bool is_curved : {true, false}) {  // a published table has a few dozen rows
    const Eigen::MatrixXd a = surface(of, rows, is_curved);
    if (a.rows() < a.cols()) continue;
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
    qr.setThreshold(kRankThreshold);
    qr.compute(a);
    const auto numbers = static_cast<std::size_t>(qr.rank());
    if (rows.size() < kRowsPerNumber * numbers) continue;
    const Eigen::VectorXd rest = b - a * qr.solve(b);
    std::vector<double> sizes;
    for (const double r : rest) sizes.push_back(std::abs(r));
    const double count = static_cast<double>(rows.size());
    return sigma_by_mad(std::move(sizes)) * std::sqrt(count / (count - static_cast<double>(numbers)));
  }
  return std::numeric_limits<double>::infinity();
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
