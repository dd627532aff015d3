// Exact bounds of a count of n independent chances p.
//
//   const auto [low, high] = binomial_bounds(100'000, 0.25, 1e-6);   // outside of them with at most 1e-6 on each side
//   EXPECT_GE(count, low);
//   EXPECT_LE(count, high);
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace omnihil {

// P(k) by logarithms of the gamma function.
inline double binomial_probability(std::uint64_t n, double p, std::uint64_t k) {
  if (p <= 0.0) return k == 0 ? 1.0 : 0.0;
  if (p >= 1.0) return k == n ? 1.0 : 0.0;
  const auto N = static_cast<double>(n), K = static_cast<double>(k);
  return std::exp(std::lgamma(N + 1.0) - std::lgamma(K + 1.0) - std::lgamma(N - K + 1.0) + K * std::log(p) +
                  (N - K) * std::log1p(-p));
}

// The least and the greatest count that are not in the tails of this probability each.
inline std::pair<std::uint64_t, std::uint64_t> binomial_bounds(std::uint64_t n, double p, double tail) {
  // 40 deviations and 100 off the mean the tails are below 1e-100: they are not summed.
  const double mean = static_cast<double>(n) * p, far = 40.0 * std::sqrt(mean) + 100.0;
  auto low = static_cast<std::uint64_t>(std::max(0.0, mean - far));
  auto high = std::min(n, static_cast<std::uint64_t>(mean + far));
  for (double sum = binomial_probability(n, p, low); sum < tail && low < n;
       sum += binomial_probability(n, p, low))
    ++low;
  for (double sum = binomial_probability(n, p, high); sum < tail && high > 0;
       sum += binomial_probability(n, p, high))
    --high;
  return {low, high};
}

}  // namespace omnihil
