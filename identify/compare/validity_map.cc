#include "identify/compare/validity_map.h"

#include <algorithm>
#include <cmath>

namespace omnihil {
namespace {

constexpr std::size_t kColumns = 12, kRows = 8;  // a choice: what a reader takes in at once
constexpr double kTail = 0.005;                  // of the samples, left out at each end of an axis; a choice

struct Sample {
  double x = 0.0, y = 0.0, error = 0.0;  // error: model minus measurement
  bool fitted = false;
};

const RegimeTrack* find(const std::vector<RegimeTrack>& tracks, const std::string& name) {
  const auto it =
      std::find_if(tracks.begin(), tracks.end(), [&](const RegimeTrack& t) { return t.name == name; });
  return it == tracks.end() ? nullptr : &*it;
}

bool varies(const RegimeTrack& track) {
  double low = INFINITY, high = -INFINITY;
  for (const double v : track.value) {
    if (!std::isfinite(v)) continue;
    low = std::min(low, v);
    high = std::max(high, v);
  }
  return high > low;
}

// `cells` cells of equal width between the quantiles; empty: no width.
std::vector<double> edges_of(std::vector<double> values, std::size_t cells) {
  if (values.size() < 2) return {};
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  double low = at(kTail), high = at(1.0 - kTail);
  if (!(high > low)) {
    low = values.front();
    high = values.back();
  }
  if (!(high > low)) return {};
  std::vector<double> edges(cells + 1);
  for (std::size_t i = 0; i <= cells; ++i)
    edges[i] = low + (high - low) * static_cast<double>(i) / static_cast<double>(cells);
  return edges;
}

// The cell that a value lies in; none outside the edges. The last edge belongs to the last cell.
std::size_t cell_of(const std::vector<double>& edges, double v) {
  constexpr auto kNone = static_cast<std::size_t>(-1);
  if (!(v >= edges.front() && v <= edges.back())) return kNone;
  const auto it = std::upper_bound(edges.begin(), edges.end(), v);
  return std::min<std::size_t>(static_cast<std::size_t>(it - edges.begin()) - 1, edges.size() - 2);
}

class MapMaker {
 public:
  MapMaker(ValidityMap& map) : map_(map) {}

  void add_run(const Predictor& predictor, const Candidate& candidate, const Prediction& prediction,
               int run) {
    const std::vector<ComparedSignal>& compared = predictor.compared(run);
    const auto signal = std::find_if(compared.begin(), compared.end(),
                                     [&](const ComparedSignal& s) { return s.name == map_.signal; });
    if (signal == compared.end() || !prediction.finite) return;
    const std::vector<RegimeTrack> tracks = predictor.regimes(candidate, run);
    const RegimeTrack* x = find(tracks, map_.x.name);
    const RegimeTrack* y = find(tracks, map_.y.name);
    if (x == nullptr || y == nullptr) return;
    map_.unit = signal->unit;
    map_.x.unit = x->unit;
    map_.y.unit = y->unit;
    const std::vector<double>& model = prediction.values[static_cast<std::size_t>(signal - compared.begin())];
    std::vector<double> residual(model.size());
    for (std::size_t i = 0; i < model.size(); ++i) residual[i] = signal->measured[i] - model[i];
    residual = averaged(*signal, std::move(residual));
    const std::vector<double> measured = averaged(*signal, signal->measured);
    const bool fitted = predictor.run(run).split == kTraining;
    for (std::size_t i = 0; i < std::min({model.size(), x->value.size(), y->value.size()}); ++i) {
      if (!std::isfinite(residual[i])) continue;
      samples_.push_back({x->value[i], y->value[i], -residual[i], fitted});
      sum_ += measured[i];
      square_ += measured[i] * measured[i];
    }
  }

  void finish() {
    if (samples_.empty()) return;
    const auto n = static_cast<double>(samples_.size());
    const double mean = sum_ / n;
    map_.spread = std::sqrt(std::max(0.0, square_ / n - mean * mean));
    std::vector<double> xs, ys;
    for (const Sample& s : samples_) {
      if (std::isfinite(s.x)) xs.push_back(s.x);
      if (std::isfinite(s.y)) ys.push_back(s.y);
    }
    map_.x.edges = edges_of(std::move(xs), kColumns);
    map_.y.edges = edges_of(std::move(ys), kRows);
    if (map_.x.edges.empty() || map_.y.edges.empty()) return;
    map_.cells.resize(kColumns * kRows);
    std::vector<double> error(map_.cells.size()), square(map_.cells.size());
    for (const Sample& s : samples_) {
      const std::size_t column = cell_of(map_.x.edges, s.x), row = cell_of(map_.y.edges, s.y);
      if (column >= kColumns || row >= kRows) {
        ++map_.outside;
        continue;
      }
      const std::size_t at = row * kColumns + column;
      ++map_.samples;
      ++(s.fitted ? map_.cells[at].fitted : map_.cells[at].unseen);
      if (s.fitted) continue;
      error[at] += s.error;
      square[at] += s.error * s.error;
    }
    for (std::size_t at = 0; at < map_.cells.size(); ++at) {
      ValidityCell& cell = map_.cells[at];
      if (cell.unseen < kLeastSamples) continue;
      cell.bias = error[at] / static_cast<double>(cell.unseen);
      cell.rmse = std::sqrt(square[at] / static_cast<double>(cell.unseen));
    }
  }

 private:
  ValidityMap& map_;
  std::vector<Sample> samples_;
  double sum_ = 0.0, square_ = 0.0;
};

}  // namespace

std::array<std::string, 2> validity_axes(const Predictor& predictor, const Candidate& candidate) {
  std::array<std::string, 2> axes;
  // What a drive's errors depend on first; then whatever varies, in the predictor's order.
  std::vector<std::string> names = {"speed", "abs_current", "acceleration", "bus_voltage", "position"};
  std::vector<std::string> varying;
  for (int r = 0; r < predictor.run_count(); ++r) {
    for (const RegimeTrack& track : predictor.regimes(candidate, r)) {
      if (std::find(names.begin(), names.end(), track.name) == names.end()) names.push_back(track.name);
      if (varies(track)) varying.push_back(track.name);
    }
  }
  std::size_t found = 0;
  for (const std::string& name : names) {
    if (found < axes.size() && std::find(varying.begin(), varying.end(), name) != varying.end())
      axes[found++] = name;
  }
  return found == axes.size() ? axes : std::array<std::string, 2>{};
}

ValidityMap validity_map(const Predictor& predictor, const Candidate& candidate,
                         std::span<const Prediction> predictions, const std::string& signal,
                         const std::array<std::string, 2>& axes) {
  ValidityMap map;
  map.signal = signal;
  map.x.name = axes[0];
  map.y.name = axes[1];
  MapMaker maker(map);
  for (int r = 0; r < predictor.run_count(); ++r)
    maker.add_run(predictor, candidate, predictions[static_cast<std::size_t>(r)], r);
  maker.finish();
  return map;
}

}  // namespace omnihil
