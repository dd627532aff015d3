// Captures of other tools: whatever is read is in order, and what is written of it is read and written alike again.
#include <algorithm>

#include "hil/capture/asc.h"
#include "hil/capture/candump.h"
#include "hil/capture/pcapng.h"
#include "hil/capture/read_capture.h"
#include "hil/capture/timed_csv.h"
#include "tests/fuzz/fuzz_target.h"

namespace omnihil {
namespace {

template <class Write>
void demand_same_again(const std::vector<Captured>& pieces, Write&& write, const char* form) {
  const std::string text = write(pieces);
  demand(pieces.empty() || is_capture(text), form);
  if (!pieces.empty()) demand(write(read_capture(text, "again", {}).pieces) == text, form);
}

void try_host_bytes(const Capture& capture) {
  try {
    for (const Captured& piece : host_bytes(capture, {}, "fuzz").pieces)
      demand(piece.at_ns >= 0, "times from 0");
  } catch (const BadCapture& error) {
    demand(*error.what() != 0, "a refusal has words");
  }
}

}  // namespace
}  // namespace omnihil

OMNIHIL_FUZZ_TARGET(bytes) {
  using namespace omnihil;
  const std::string text(text_of(bytes));
  Capture capture;
  try {
    capture = read_capture(text, "fuzz", {});
  } catch (const BadCapture& error) {
    return demand(*error.what() != 0, "a refusal has words");
  }
  demand(std::ranges::is_sorted(capture.pieces, {}, &Captured::at_ns), "in the order of their times");
  demand(capture.pieces.empty() || capture.pieces.front().at_ns >= 0, "no time below 0");
  for (const std::string& note : capture.notes) demand(note.starts_with("fuzz:"), "a note names the file");
  try_host_bytes(capture);
  demand_same_again(
      capture.pieces, [](const auto& pieces) { return write_timed_csv(pieces); }, "CSV");
  std::vector<Captured> frames = capture.pieces;
  std::erase_if(frames, [](const Captured& each) {
    return each.carrier != CaptureCarrier::kCan || (!each.fd && each.bytes.size() > 8);
  });
  std::erase_if(frames, [](const Captured& each) { return !is_can_length(each.bytes.size(), each.fd); });
  demand_same_again(
      frames, [](const auto& pieces) { return write_candump(pieces, "can0"); }, "candump");
  demand_same_again(
      frames, [](const auto& pieces) { return write_asc(pieces); }, "asc");
  demand_same_again(
      frames, [](const auto& pieces) { return write_pcapng(pieces, "omnihil"); }, "pcapng");
}
