#include "identify/compare/regime_bins.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace omnihil {
namespace {

// Choices of resolution; a report's curves follow from them, no verdict. Sensitivity not measured.
constexpr int kWidths = 24;           // bins of equal width over the axis; a choice
constexpr int kShares = 24;           // quantiles that part bins further where the samples crowd; a choice
constexpr int kAngleBins = 48;        // resolves up to 12 periods per turn with four bins each: derived
constexpr double kLeastShare = 1e-3;  // of the samples, per bin; a choice
constexpr std::size_t kLeastSamples = 5;  // per bin: a standard error from blocks needs several; a choice

bool is_angle(std::string_view axis) { return axis.ends_with("_angle"); }

double wrapped(double angle_rad) {
  const double turn = 2.0 * std::numbers::pi;
  return angle_rad - turn * std::floor(angle_rad / turn);
}

std::vector<double> known_sorted(const std::vector<double>& axis) {
  std::vector<double> known;
  for (const double v : axis) {
    if (std::isfinite(v)) known.push_back(v);
  }
  std::sort(known.begin(), known.end());
  return known;
}

// Edges from the first to past the last value; a bin holds its lower edge.
std::vector<double> edges_for(std::string_view axis, const std::vector<double>& sorted) {
  if (axis == "direction") return {-1.5, -0.5, 0.5, 1.5};
  std::vector<double> wanted;
  const double low = sorted.front(), high = sorted.back();
  const auto n = sorted.size();
  for (int i = 1; i < kWidths; ++i) wanted.push_back(low + (high - low) * i / kWidths);
  for (int i = 1; i < kShares; ++i) wanted.push_back(sorted[n * static_cast<std::size_t>(i) / kShares]);
  std::sort(wanted.begin(), wanted.end());
  // keep an edge when enough samples lie since the one before, and after it
  const auto least = std::max(kLeastSamples, static_cast<std::size_t>(kLeastShare * static_cast<double>(n)));
  std::vector<double> edges{low};
  std::size_t counted = 0;
  for (const double edge : wanted) {
    const auto below =
        static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), edge) - sorted.begin());
    if (below < counted + least || n - below < least) continue;
    edges.push_back(edge);
    counted = below;
  }
  edges.push_back(std::nextafter(high, INFINITY));
  return edges;
}

struct BlockSum {
  double sum = 0.0;
  double count = 0.0;
};

// Mean of a bin and its standard error from its blocks.
void mean_of(const std::vector<BlockSum>& blocks, double rms, RegimeBin& bin) {
  double sum = 0.0, count = 0.0, square = 0.0, used = 0.0;
  for (const BlockSum& b : blocks) sum += b.sum, count += b.count;
  if (count == 0.0) return;
  bin.mean = sum / count;
  for (const BlockSum& b : blocks) {
    if (b.count == 0.0) continue;
    const double off = b.sum - bin.mean * b.count;
    square += off * off;
    used += 1.0;
  }
  bin.sigma = used > 1.5 ? std::sqrt(square * used / (used - 1.0)) / count : rms;
}

}  // namespace

RegimeError regime_error(std::string_view axis, const RegimeSamples& samples) {
  RegimeError out;
  out.axis = axis;
  std::vector<double> place = samples.axis;
  if (is_angle(axis)) std::transform(place.begin(), place.end(), place.begin(), wrapped);
  const std::vector<double> sorted = known_sorted(place);
  if (sorted.size() < 2 * kLeastSamples || sorted.front() == sorted.back()) return out;
  std::vector<double> edges;
  if (is_angle(axis)) {
    for (int i = 0; i <= kAngleBins; ++i) edges.push_back(2.0 * std::numbers::pi * i / kAngleBins);
    edges.back() = std::nextafter(edges.back(), INFINITY);
  } else {
    edges = edges_for(axis, sorted);
  }
  const std::size_t bins = edges.size() - 1;
  std::vector<std::vector<BlockSum>> blocks(bins, std::vector<BlockSum>(kBlocks));
  std::vector<double> energy(bins), count(bins);
  double total = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < samples.residual.size(); ++i) {
    const double r = samples.residual[i];
    total += r * r;
    sum += r;
    if (!std::isfinite(place[i])) continue;
    const auto bin = static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(std::upper_bound(edges.begin(), edges.end(), place[i]) - edges.begin() - 1,
                                   0, static_cast<std::ptrdiff_t>(bins) - 1));
    energy[bin] += r * r;
    count[bin] += 1.0;
    BlockSum& block = blocks[bin][static_cast<std::size_t>(samples.block[i])];
    block.sum += r;
    block.count += 1.0;
  }
  const auto n = static_cast<double>(samples.residual.size());
  const double rms = std::sqrt(total / n), mean = sum / n;
  const double about_mean = total - n * mean * mean;
  double explained = 0.0;
  for (std::size_t b = 0; b < bins; ++b) {
    RegimeBin bin{.from = edges[b], .to = edges[b + 1]};
    bin.energy_share = total > 0.0 ? energy[b] / total : 0.0;
    bin.time_share = count[b] / n;
    mean_of(blocks[b], rms, bin);
    // what the bin's mean explains beyond the mean of all, less what a mean of noise would
    explained += count[b] * ((bin.mean - mean) * (bin.mean - mean) - bin.sigma * bin.sigma);
    if (count[b] > 0.0) out.bins.push_back(bin);
  }
  out.explained_fraction = about_mean > 0.0 ? std::clamp(explained / about_mean, 0.0, 1.0) : 0.0;
  return out;
}

}  // namespace omnihil
