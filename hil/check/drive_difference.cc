#include "hil/check/drive_difference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "hil/recording/recorded_samples.h"

namespace omnihil {
namespace {

constexpr double kLeastDuty = 0.01;       // below it a ratio of two duties is rounding
constexpr double kLeastSilence_s = 0.05;  // no league host sends more seldom than 20 times a second
constexpr double kSilentIntervals = 5.0;  // a choice: four packets lost in a row are still a link
constexpr double kLeastReversed = 0.5;    // a choice: of the recorded duty

using Places = std::vector<std::size_t>;

// Places of NAME_1 … NAME_4; empty where a column is missing.
Places wheel_places(const RecordingHeader& header, std::string_view name) {
  Places places;
  for (int wheel = 1; wheel <= static_cast<int>(kWheels); ++wheel) {
    const std::size_t place = column_place(header, fmt::format("{}_{}", name, wheel));
    if (place == header.columns.size()) return {};
    places.push_back(place);
  }
  return places;
}

// When the host wrote, up to `now_ns`.
std::vector<std::int64_t> host_times(const Recording& recording, std::int64_t now_ns) {
  std::vector<std::int64_t> times;
  for (const RecordedChunk& chunk : recording.chunks) {
    if (chunk.now_ns > now_ns) break;
    if (chunk.kind != RecordedChunk::Kind::kHostBytes) continue;
    if (times.empty() || times.back() != chunk.now_ns) times.push_back(chunk.now_ns);
  }
  return times;
}

double median_interval_s(const std::vector<std::int64_t>& times) {
  std::vector<std::int64_t> gaps;
  for (std::size_t i = 1; i < times.size(); ++i) gaps.push_back(times[i] - times[i - 1]);
  if (gaps.empty()) return 0.0;
  const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2);
  std::ranges::nth_element(gaps, middle);
  return static_cast<double>(*middle) / 1e9;
}

struct Columns {
  Places duty, mode, encoder;
  explicit Columns(const RecordingHeader& header)
      : duty(wheel_places(header, "duty_ratio")),
        mode(wheel_places(header, "drive_mode")),
        encoder(wheel_places(header, "encoder_counts")) {}
  bool complete() const { return !duty.empty() && !mode.empty() && !encoder.empty(); }
};

// Both samples of one robot at one time.
struct Pair {
  const RecordedChunk& recorded;
  const RecordedChunk& replayed;
  const Columns& from;
  const Columns& to;

  double recorded_duty(std::size_t wheel) const { return recorded.sample[from.duty[wheel]]; }
  double replayed_duty(std::size_t wheel) const { return replayed.sample[to.duty[wheel]]; }
  bool mode_differs(std::size_t wheel) const {
    return recorded.sample[from.mode[wheel]] != replayed.sample[to.mode[wheel]];
  }
  bool encoders_differ() const {
    for (std::size_t wheel = 0; wheel < kWheels; ++wheel) {
      if (recorded.sample[from.encoder[wheel]] != replayed.sample[to.encoder[wheel]]) return true;
    }
    return false;
  }
};

std::optional<DriveDifference> difference_of(const Pair& pair, double tolerance) {
  DriveDifference out;
  double largest = -1.0;
  for (std::size_t wheel = 0; wheel < kWheels; ++wheel) {
    const double a = pair.recorded_duty(wheel), b = pair.replayed_duty(wheel);
    const bool modes = pair.mode_differs(wheel);
    out.ratio[wheel] = std::abs(a) < kLeastDuty ? std::numeric_limits<double>::quiet_NaN() : b / a;
    out.mode_differs = out.mode_differs || modes;
    if (!modes && std::abs(a - b) <= tolerance) continue;
    if (std::abs(a - b) <= largest) continue;
    largest = std::abs(a - b);
    out.wheel = static_cast<int>(wheel);
    out.recorded_duty = a;
    out.replayed_duty = b;
  }
  if (largest < 0.0) return std::nullopt;
  return out;
}

// "wheels 1 to 4: 1.05, 1.05, 1.04, –"
std::string ratios_text(const std::array<double, kWheels>& ratio) {
  std::string text;
  for (const double r : ratio) {
    text += (text.empty() ? "" : ", ") + (std::isfinite(r) ? fmt::format("{:.3f}", r) : std::string("-"));
  }
  return "wheels 1 to 4 " + text + " times the recorded duty";
}

// What such a difference is, in a word or two; empty where nothing stands out.
std::string kind_of(const DriveDifference& d) {
  // No command came for long, and up to here both answered alike: what changes is what they do without one.
  if (d.host_silent_s >= kLeastSilence_s && d.host_silent_s > kSilentIntervals * d.host_interval_s) {
    return fmt::format(": {:.3f} s after the host's last byte, a time-out", d.host_silent_s);
  }
  // Of the opposite sign and of like size: one wheel's noise around zero is not.
  const bool reversed = std::ranges::any_of(d.ratio, [](double r) { return r < -kLeastReversed; });
  return reversed ? ": a sign" : "";
}

}  // namespace

std::string DriveDifference::text() const {
  std::string text = fmt::format("robot {}, {:.4f} s, wheel {}: duty {:.4g} instead of {:.4g}", robot_id,
                                 static_cast<double>(now_ns) / 1e9, wheel + 1, replayed_duty, recorded_duty);
  if (mode_differs) text += ", bridges in another mode";
  text += "; " + ratios_text(ratio) + kind_of(*this);
  if (sensors_differ) text += " (the encoders differ already)";
  return text;
}

std::optional<DriveDifference> first_drive_difference(const Recording& recorded, const Recording& replayed,
                                                      double tolerance) {
  const Columns from(recorded.header), to(replayed.header);
  if (!from.complete() || !to.complete()) return std::nullopt;
  const auto a = samples_of(recorded), b = samples_of(replayed);
  bool sensors_differ = false;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    if (a[i]->now_ns != b[i]->now_ns || a[i]->robot_id != b[i]->robot_id) return std::nullopt;
    const Pair pair{*a[i], *b[i], from, to};
    sensors_differ = sensors_differ || pair.encoders_differ();
    std::optional<DriveDifference> found = difference_of(pair, tolerance);
    if (!found) continue;
    found->now_ns = a[i]->now_ns;
    found->robot_id = a[i]->robot_id;
    const std::vector<std::int64_t> host = host_times(recorded, found->now_ns);
    found->host_silent_s = static_cast<double>(found->now_ns - (host.empty() ? 0 : host.back())) / 1e9;
    found->host_interval_s = median_interval_s(host);
    found->sensors_differ = sensors_differ;
    return found;
  }
  return std::nullopt;
}

}  // namespace omnihil
