#include "hil/check/signal_series.h"

#include <algorithm>

#include "hil/recording/recorded_packets.h"

namespace omnihil {
namespace {

double time_in_s(std::int64_t now_ns) { return static_cast<double>(now_ns) / 1e9; }

SignalSeries of_column(const Recording& recording, std::size_t column, int robot_id) {
  SignalSeries series;
  for (const RecordedChunk& chunk : recording.chunks) {
    if (chunk.kind != RecordedChunk::Kind::kSample || chunk.robot_id != robot_id) continue;
    series.time_s.push_back(time_in_s(chunk.now_ns));
    series.value.push_back(chunk.sample[column]);
  }
  return series;
}

SignalSeries of_field(const Recording& recording, const RadioFormat& format, std::string_view message,
                      std::string_view field, int robot_id) {
  SignalSeries series;
  for (const RecordedPacket& packet : dongle_packets(recording, format)) {
    if (!packet.frame.understood) continue;
    const DecodeResult decoded = format.decode(packet.frame.bytes);
    if (decoded.values.message->name != message || packet_robot(decoded.values) != robot_id) continue;
    if (decoded.values.message->field_index(field) < 0) return {};
    series.time_s.push_back(time_in_s(packet.now_ns));
    series.value.push_back(decoded.values.number(field));
  }
  return series;
}

}  // namespace

SignalSeries signal_series(const Recording& recording, const RadioFormat& format, std::string_view name,
                           int robot_id) {
  const auto& columns = recording.header.columns;
  const auto column = std::ranges::find(columns, name);
  if (column != columns.end())
    return of_column(recording, static_cast<std::size_t>(column - columns.begin()), robot_id);
  const std::size_t dot = name.find('.');
  if (dot == std::string_view::npos) return {};
  return of_field(recording, format, name.substr(0, dot), name.substr(dot + 1), robot_id);
}

}  // namespace omnihil
