// Recordings, streams to play and logs of a radio. What a reader of recordings takes holds what it says: times in order,
// samples of as many values as the header has columns.
#include <sstream>

#include "hil/recording/log_import.h"
#include "hil/recording/recording_reader.h"
#include "hil/recording/stream_file.h"
#include "tests/fuzz/fuzz_target.h"

namespace omnihil {
namespace {

void read_recording(const std::string& text) {
  std::istringstream stream(text);
  RecordingReader reader(stream, "fuzz.omnirec");
  RecordedChunk chunk;
  std::int64_t last_ns = 0;
  while (reader.next(chunk)) {
    demand(chunk.now_ns >= last_ns, "times do not go back");
    last_ns = chunk.now_ns;
    if (chunk.kind == RecordedChunk::Kind::kSample) {
      demand(chunk.sample.size() == reader.header().columns.size(), "a value for each column");
    }
  }
  demand(reader.problems().size() <= RecordingReader::kMaxProblems + 1, "an end to the problems");
}

template <class Read>
void refused_or_read(Read&& read) {
  try {
    read();
  } catch (const BadStream&) {
  } catch (const BadRecording&) {
  }
}

}  // namespace
}  // namespace omnihil

OMNIHIL_FUZZ_TARGET(bytes) {
  using namespace omnihil;
  const std::string text(text_of(bytes));
  read_recording(text);
  refused_or_read([&] { parse_stream(text, "fuzz.txt", ""); });
  refused_or_read([&] { parse_radio_log(text, "fuzz.txt", 1'000'000); });
}
