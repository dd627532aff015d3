#include "hil/recording/capture_import.h"

#include <fmt/format.h>

#include <algorithm>

#include "hil/recording/recorded_packets.h"
#include "hil/recording/stream_frames.h"

namespace omnihil {
namespace {

constexpr std::int64_t kTimeRounding_ns = 1'000;  // of a time that was written with six decimals
constexpr std::int64_t kLongest_ns = 86'400LL * 1'000'000'000;  // a longer log has a unit that is not its own

// By the first packet in these bytes; unknown where there is none, or both sides send it.
CaptureWay way_by_packet(const std::vector<std::uint8_t>& bytes, const RadioFormat& format) {
  FrameCutter cutter(format);
  cutter.push(bytes);
  cutter.finish();
  while (const auto frame = cutter.next()) {
    const DecodeResult decoded = format.decode(frame->bytes);
    if (!frame->understood || decoded.error != PacketError::kNone) continue;
    switch (decoded.values.message->direction) {
      case Direction::kToRobot:
      case Direction::kToDongle:
        return CaptureWay::kFromHost;
      case Direction::kFromRobot:
      case Direction::kFromDongle:
        return CaptureWay::kToHost;
      default:
        break;
    }
  }
  return CaptureWay::kUnknown;
}

Captured piece_at(const Recording& recording, std::int64_t now_ns, bool from_host,
                  std::vector<std::uint8_t> bytes) {
  Captured piece;
  piece.at_ns = static_cast<std::int64_t>(recording.header.epoch_ms) * 1'000'000 + now_ns;
  piece.way = from_host ? CaptureWay::kFromHost : CaptureWay::kToHost;
  piece.bytes = std::move(bytes);
  return piece;
}

}  // namespace

CaptureImport import_capture(const Capture& capture, const CaptureFilter& filter, const RadioFormat& format,
                             const std::string& name, std::int64_t grid_ns) {
  HostBytes both = host_bytes(capture, filter, name);
  CaptureImport out;
  out.notes = std::move(both.notes);
  out.unix_time = both.unix_time;
  out.start_ns = both.start_ns / grid_ns * grid_ns;
  const std::int64_t first_ns = both.start_ns - out.start_ns;
  std::size_t decided = 0, undecided = 0;
  for (Captured& piece : both.pieces) {
    if (piece.at_ns > kLongest_ns)
      throw BadCapture(fmt::format("{}: time: found {} s after the first, allowed: within a day", name,
                                   piece.at_ns / 1'000'000'000));
    if (piece.way == CaptureWay::kUnknown) {
      piece.way = way_by_packet(piece.bytes, format);
      ++(piece.way == CaptureWay::kUnknown ? undecided : decided);
    }
    RecordedChunk chunk;
    chunk.kind = piece.way == CaptureWay::kToHost ? RecordedChunk::Kind::kDongleBytes
                                                  : RecordedChunk::Kind::kHostBytes;
    chunk.now_ns = first_ns + piece.at_ns;
    chunk.bytes = std::move(piece.bytes);
    out.chunks.push_back(std::move(chunk));
  }
  if (decided > 0)
    out.notes.push_back(
        fmt::format("{}: the capture does not say which way {} pieces went: their packets of {} do", name,
                    decided, format.id));
  if (undecided > 0)
    out.notes.push_back(
        fmt::format("{}: neither capture nor packet says which way {} pieces went: taken as the host's", name,
                    undecided));
  return out;
}

std::int64_t put_off_to_steps(std::vector<RecordedChunk>& chunks, std::int64_t step_ns) {
  std::int64_t most_ns = 0;
  for (RecordedChunk& chunk : chunks) {
    if (chunk.kind != RecordedChunk::Kind::kHostBytes) continue;
    // The loop takes what has come by a step's start: the first step after the write.
    const std::int64_t written_ns = chunk.now_ns;
    chunk.now_ns =
        std::max<std::int64_t>(0, (written_ns - kTimeRounding_ns + step_ns - 1) / step_ns * step_ns);
    most_ns = std::max(most_ns, chunk.now_ns - written_ns);
  }
  // A host's write that was put off may have passed a dongle's.
  std::ranges::stable_sort(chunks, {}, &RecordedChunk::now_ns);
  return most_ns;
}

std::vector<Captured> pieces_of(const Recording& recording) {
  std::vector<Captured> pieces;
  for (const RecordedChunk& chunk : recording.chunks) {
    const bool from_host = chunk.kind == RecordedChunk::Kind::kHostBytes;
    if ((from_host || chunk.kind == RecordedChunk::Kind::kDongleBytes) && !chunk.bytes.empty())
      pieces.push_back(piece_at(recording, chunk.now_ns, from_host, chunk.bytes));
  }
  return pieces;
}

std::vector<Captured> packets_of(const Recording& recording, const RadioFormat& format) {
  std::vector<Captured> pieces;
  for (PassedPacket& passed : all_packets(recording, format))
    pieces.push_back(
        piece_at(recording, passed.packet.now_ns, passed.from_host, std::move(passed.packet.frame.bytes)));
  return pieces;
}

}  // namespace omnihil
