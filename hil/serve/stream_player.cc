#include "hil/serve/stream_player.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>

#include "hil/recording/stream_frames.h"
#include "hil/wire/descriptor.h"
#include "hil/wire/send_queue.h"

namespace omnihil {
namespace {

constexpr std::int64_t kLongestWait_ns = 100'000'000;  // how late `stop` may be seen
constexpr std::size_t kBite_bytes = 4096;

class Player {
 public:
  Player(const HostStream& stream, ByteWire& wire, const PlayOptions& options,
         const volatile std::sig_atomic_t& stop)
      : stream_(stream), wire_(wire), options_(options), stop_(stop) {
    if (options.format != nullptr) cutter_.emplace(*options.format);
  }

  PlaySummary run() {
    do {
      round_start_ns_ = now_ns();
      for (const StreamChunk& chunk : stream_.chunks) {
        serve_until(due_ns(chunk));
        if (over()) break;
        begin_write(chunk);
      }
      if (!over()) ++summary_.rounds;
    } while (options_.loop && !over());
    serve_until(now_ns() + static_cast<std::int64_t>(options_.linger_s * 1e9));
    finish();
    return std::move(summary_);
  }

 private:
  std::int64_t now_ns() const {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now() - start_)
        .count();
  }
  std::int64_t due_ns(const StreamChunk& chunk) const {
    return round_start_ns_ + static_cast<std::int64_t>(static_cast<double>(chunk.at_ns) / options_.speed);
  }
  bool over() const { return stop_ != 0 || static_cast<bool>(summary_.error); }

  void begin_write(const StreamChunk& chunk) {
    const double late_s = static_cast<double>(now_ns() - due_ns(chunk)) * 1e-9;
    summary_.latest_s = std::max(summary_.latest_s, late_s);
    waiting_.append(chunk.bytes);
    ++summary_.writes;
    write_waiting();
  }

  void write_waiting() {
    if (!over()) summary_.bytes_written += waiting_.flush(wire_, summary_.error);
  }

  // Reads and writes until the time is reached; past it, what waits is still tried once.
  void serve_until(std::int64_t until_ns) {
    while (!over()) {
      const std::int64_t left_ns = until_ns - now_ns();
      if (left_ns <= 0) break;
      wait_for(wire_.handle(), std::min(left_ns, kLongestWait_ns),
               waiting_.waiting() > 0);  // read() says why it is gone
      read_answers();
      write_waiting();
    }
  }

  void read_answers() {
    std::vector<std::uint8_t> answer;
    summary_.error = wire_.read(answer, kBite_bytes);
    summary_.bytes_read += answer.size();
    if (!cutter_ || answer.empty()) return;
    cutter_->push(answer);
    count_frames();
  }

  void count_frames() {
    while (const auto frame = cutter_->next()) {
      if (!frame->understood) {
        summary_.bytes_not_understood += frame->bytes.size();
      } else {
        ++summary_.packets[std::string(options_.format->decode(frame->bytes).values.message->name)];
      }
    }
  }

  void finish() {
    summary_.stopped = stop_ != 0;
    summary_.wall_s = static_cast<double>(now_ns()) * 1e-9;
    if (!cutter_) return;
    cutter_->finish();
    count_frames();
  }

  const HostStream& stream_;
  ByteWire& wire_;
  const PlayOptions& options_;
  const volatile std::sig_atomic_t& stop_;
  std::optional<FrameCutter> cutter_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::int64_t round_start_ns_ = 0;
  SendQueue waiting_;  // bytes that the device has not taken yet
  PlaySummary summary_;
};

}  // namespace

PlaySummary play_stream(const HostStream& stream, ByteWire& wire, const PlayOptions& options,
                        const volatile std::sig_atomic_t& stop) {
  return Player(stream, wire, options, stop).run();
}

std::string PlaySummary::text() const {
  std::string out = fmt::format("wrote {} times, {} bytes in {:.2f} s; latest {:.2f} ms after its time\n",
                                writes, bytes_written, wall_s, latest_s * 1e3);
  out += fmt::format("read {} bytes", bytes_read);
  for (const auto& [name, count] : packets) out += fmt::format(", {} {}", count, name);
  if (bytes_not_understood > 0) out += fmt::format(", {} bytes not understood", bytes_not_understood);
  return out + "\n";
}

}  // namespace omnihil
