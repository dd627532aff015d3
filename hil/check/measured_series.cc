#include "hil/check/measured_series.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string_view>

#include "hil/check/signal_series.h"
#include "hil/recording/recorded_packets.h"
#include "protocols/codec.h"
#include "sim/robot/plant.h"

namespace omnihil {
namespace {

enum class Take : std::uint8_t {
  kValue,
  kRate,
  kTurnRate
};  // as it is; its rate; an angle's rate, the short way

constexpr std::array<std::string_view, 7> kPhysicalUnits{"m/s", "rad/s", "m/s^2", "A", "V", "N", "Nm"};

double seconds(std::int64_t now_ns) { return static_cast<double>(now_ns) / 1e9; }

void as_rate(MeasuredSeries& series) {
  std::vector<double> time_s, rate;
  for (std::size_t i = 1; i < series.value.size(); ++i) {
    const double dt_s = series.time_s[i] - series.time_s[i - 1];
    if (!(dt_s > 0.0)) continue;
    time_s.push_back(series.time_s[i]);
    rate.push_back((series.value[i] - series.value[i - 1]) / dt_s);
  }
  series.time_s = std::move(time_s);
  series.value = std::move(rate);
  series.unit += "/s";
}

void add_column(const Recording& recording, const RadioFormat& format, const std::string& name, Take take,
                std::vector<MeasuredSeries>& all) {
  const auto& columns = recording.header.columns;
  const auto at = std::ranges::find(columns, name);
  if (at == columns.end()) return;
  const std::string& unit = recording.header.units[static_cast<std::size_t>(at - columns.begin())];
  for (const int robot : recording.header.robot_ids) {
    SignalSeries signal = signal_series(recording, format, name, robot);
    MeasuredSeries series{name, unit, robot, 0.0, std::move(signal.time_s), std::move(signal.value)};
    if (take == Take::kRate) as_rate(series);
    if (!series.value.empty()) all.push_back(std::move(series));
  }
}

std::vector<MeasuredSeries> sensors_of(const Recording& recording, const RadioFormat& format) {
  std::vector<MeasuredSeries> all;
  for (int wheel = 1; wheel <= static_cast<int>(kWheels); ++wheel) {
    const std::string number = "_" + std::to_string(wheel);
    add_column(recording, format, "encoder_counts" + number, Take::kRate, all);
    add_column(recording, format, "motor_current_A" + number, Take::kValue, all);
  }
  for (const char* name : {"bus_voltage_V", "gyro_z_rad_s", "accel_x_m_s2", "accel_y_m_s2"})
    add_column(recording, format, name, Take::kValue, all);
  return all;
}

bool is_physical(const Field& field) {
  return std::ranges::find(kPhysicalUnits, field.unit) != kPhysicalUnits.end();
}

std::vector<MeasuredSeries> telemetry_of(const Recording& recording, const RadioFormat& format) {
  std::map<std::pair<std::string, int>, MeasuredSeries> all;
  for (const RecordedPacket& packet : dongle_packets(recording, format)) {
    if (!packet.frame.understood) continue;
    const DecodeResult decoded = format.decode(packet.frame.bytes);
    const Message& message = *decoded.values.message;
    const int robot = packet_robot(decoded.values);
    for (std::size_t i = 0; i < message.fields.size(); ++i) {
      const Field& field = message.fields[i];
      if (!is_physical(field)) continue;
      const std::string name = std::string(message.name) + "." + std::string(field.name);
      MeasuredSeries& series = all[{name, robot}];
      series.name = name;
      series.unit = field.unit;
      series.robot_id = robot;
      series.step = field_step(field);
      series.time_s.push_back(seconds(packet.now_ns));
      series.value.push_back(decoded.values.fields[i].number);
    }
  }
  std::vector<MeasuredSeries> list;
  for (auto& [key, series] : all) {
    if (!series.value.empty()) list.push_back(std::move(series));
  }
  return list;
}

}  // namespace

MeasuredBy measured_by(const Recording& recording) {
  const bool samples = std::ranges::any_of(recording.chunks, [](const RecordedChunk& chunk) {
    return chunk.kind == RecordedChunk::Kind::kSample;
  });
  return samples ? MeasuredBy::kSensors : MeasuredBy::kTelemetry;
}

std::vector<MeasuredSeries> measured_series(const Recording& recording, const RadioFormat& format,
                                            MeasuredBy by) {
  return by == MeasuredBy::kSensors ? sensors_of(recording, format) : telemetry_of(recording, format);
}

std::vector<double> values_at(const MeasuredSeries& series, const std::vector<double>& time_s) {
  constexpr double kSameInstant_s = 1e-9;
  std::vector<double> values;
  values.reserve(time_s.size());
  std::size_t k = 0;
  for (const double t : time_s) {
    while (k < series.time_s.size() && series.time_s[k] <= t + kSameInstant_s) ++k;
    values.push_back(k == 0 ? std::numeric_limits<double>::quiet_NaN() : series.value[k - 1]);
  }
  return values;
}

}  // namespace omnihil
