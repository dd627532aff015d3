#include "tools/convert_capture.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "hil/capture/asc.h"
#include "hil/capture/candump.h"
#include "hil/capture/decimal_time.h"
#include "hil/capture/pcapng.h"
#include "hil/capture/timed_csv.h"
#include "hil/recording/capture_import.h"
#include "hil/recording/stream_file.h"
#include "hil/text/dataset_files.h"

namespace omnihil {
namespace {

// Of a capture with CAN the frames of all ids; else the bytes of its host and dongle.
std::vector<Captured> pieces_to_write(Capture capture, const CaptureFilter& filter, const RadioFormat* format,
                                      const std::string& path) {
  const auto other = [](const Captured& each) { return each.carrier != CaptureCarrier::kCan; };
  if (!std::ranges::all_of(capture.pieces, other)) {
    const std::size_t others = std::erase_if(capture.pieces, other);
    if (others > 0)
      capture.notes.push_back(fmt::format("{}: {} pieces that are no CAN frames: left out", path, others));
    print_notes(capture.notes);
    return std::move(capture.pieces);
  }
  std::vector<Captured> pieces;
  if (format != nullptr) {
    const CaptureImport both = import_capture(capture, filter, *format, path);
    print_notes(both.notes);
    for (const RecordedChunk& chunk : both.chunks) {
      Captured& piece = pieces.emplace_back();
      piece.at_ns = both.start_ns + chunk.now_ns;
      piece.way = chunk.kind == RecordedChunk::Kind::kHostBytes ? CaptureWay::kFromHost : CaptureWay::kToHost;
      piece.bytes = chunk.bytes;
    }
    return pieces;
  }
  HostBytes both = host_bytes(capture, filter, path);
  print_notes(both.notes);
  for (Captured& piece : both.pieces) {
    piece.at_ns += both.start_ns;
    piece.carrier = CaptureCarrier::kSerial;
  }
  return std::move(both.pieces);
}

void write_stream(std::span<const Captured> pieces, const std::string& path, const std::string& out) {
  HostStream stream;
  for (const Captured& piece : pieces)
    if (piece.way == CaptureWay::kFromHost)
      stream.chunks.push_back({piece.at_ns - pieces.front().at_ns, piece.bytes});
  if (stream.chunks.empty()) throw BadCapture(path + ": found no bytes of a host, allowed: at least one");
  write_new_file(out, to_text(stream, "what a host wrote, from " + path));
  fmt::print("{}: {} writes, {} bytes\n", out, stream.chunks.size(), stream.byte_count());
}

}  // namespace

void write_pieces(std::span<const Captured> pieces, const std::string& to, const std::string& out) {
  const bool as_can = to == "candump" || to == "asc";
  const std::vector<Captured> frames =
      as_can ? as_can_frames(pieces) : std::vector<Captured>(pieces.begin(), pieces.end());
  const std::string text = to == "candump" ? write_candump(frames, "can0")
                           : to == "asc"   ? write_asc(frames)
                           : to == "csv"   ? write_timed_csv(frames)
                                           : write_pcapng(frames, "omnihil");
  write_new_file(out, text);
  const auto finer =
      std::ranges::count_if(frames, [](const Captured& each) { return each.at_ns % kMicrosecond_ns != 0; });
  if (as_can && finer > 0)
    print_notes({fmt::format(
        "{}: {} times were finer than a microsecond, which is all that the form has: cut", out, finer)});
  fmt::print("{}: {} {}\n", out, frames.size(), as_can ? "frames" : "pieces");
}

void convert_capture(const std::string& path, const std::string& to, const std::string& out,
                     const CaptureWords& words, const RadioFormat* format) {
  if (to == "dataset" || to == "mcap" || to == "pcap")
    throw std::invalid_argument(
        "--to: found " + to +
        ", allowed for a capture: candump, asc, csv, pcapng, stream; `import` makes a recording of it");
  const CaptureFilter filter = capture_filter(words);
  Capture capture = load_capture(path, filter);
  if (to == "csv") {
    print_notes(capture.notes);
    return write_pieces(capture.pieces, to, out);
  }
  const bool stream = to == "stream";
  if (stream) {  // the host's alone, also of CAN
    const HostBytes both = host_bytes(capture, filter, path);
    capture.pieces = both.pieces;
    capture.notes = both.notes;
    for (Captured& piece : capture.pieces) piece.carrier = CaptureCarrier::kSerial;
  }
  const std::vector<Captured> pieces = pieces_to_write(std::move(capture), filter, format, path);
  const bool unsaid =
      std::ranges::any_of(pieces, [](const Captured& each) { return each.way == CaptureWay::kUnknown; });
  if (unsaid && to != "pcapng" && pieces.front().carrier == CaptureCarrier::kSerial)
    throw std::invalid_argument("--radio: found none, allowed: the format of the packets in " + path +
                                ", which alone say which way they went");
  stream ? write_stream(pieces, path, out) : write_pieces(pieces, to, out);
}

}  // namespace omnihil
