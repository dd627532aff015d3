#include "hil/recording/recording_writer.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <ctime>
#include <nlohmann/json.hpp>

#include "hil/recording/command_values.h"
#include "hil/recording/recording_header.h"
#include "hil/recording/recording_memory.h"
#include "hil/text/json_text.h"
#include "hil/text/recording_text.h"

namespace omnihil {
namespace {

constexpr std::size_t kBuffer_bytes = 256 * 1024;
constexpr std::int64_t kFlushEvery_ns = 500'000'000;  // half of what the format promises

// All of `text`, whatever signals come between; 0 or the error number.
int write_all(int fd, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(fd, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

// "2026-01-02T03:04:05Z"
std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  char text[32];
  return {text, std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts)};
}

}  // namespace

std::unique_ptr<RecordingWriter> RecordingWriter::open(const std::filesystem::path& path,
                                                       RecordingHeader header, std::error_code& error,
                                                       Report report) {
  error.clear();
  const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (fd < 0) {
    error = std::error_code(errno, std::generic_category());
    return nullptr;
  }
  if (header.started.empty()) header.started = utc_now();
  std::unique_ptr<RecordingWriter> writer(
      new RecordingWriter(fd, path, with_sample_columns(std::move(header)), {}));
  writer->flush();
  writer->report_ = std::move(report);
  error = writer->error_;
  return error ? nullptr : std::move(writer);
}

RecordingWriter::RecordingWriter(int fd, std::filesystem::path path, RecordingHeader header, Report report)
    : fd_(fd),
      path_(std::move(path)),
      report_(std::move(report)),
      decimation_(robot_keys(header), header.sample_every) {
  header.sample_every = decimation_.every();
  watched_ = header.watched.size();
  buffer_.reserve(2 * kBuffer_bytes);
  buffer_ += "# " + to_json(header) + "\n";
}

RecordingWriter::~RecordingWriter() {
  flush();
  ::close(fd_);
}

void RecordingWriter::host_bytes(std::int64_t now_ns, std::span<const std::uint8_t> bytes) {
  if (!bytes.empty()) chunk('>', now_ns, bytes);
}

void RecordingWriter::dongle_bytes(std::int64_t now_ns, std::span<const std::uint8_t> bytes) {
  if (!bytes.empty()) chunk('<', now_ns, bytes);
}

void RecordingWriter::host_closed(std::int64_t now_ns) {
  if (error_) return;
  buffer_ += "! ";
  append_integer(buffer_, now_ns);
  buffer_ += " closed";
  end_line(now_ns);
}

void RecordingWriter::command(std::int64_t now_ns, int robot_id, const RobotCommand& command) {
  input('c', now_ns, robot_id, command_values(command));
}

void RecordingWriter::placed(std::int64_t now_ns, int robot_id, double x_m, double y_m, double yaw_rad) {
  const double place[] = {x_m, y_m, yaw_rad};
  input('p', now_ns, robot_id, place);
}

void RecordingWriter::field_input(std::int64_t now_ns, FieldInput kind, int robot_id,
                                  std::span<const double> values) {
  const bool of_robot = kind == FieldInput::kPushed || kind == FieldInput::kPresent;
  const char tag = kind == FieldInput::kBall     ? 'b'
                   : kind == FieldInput::kMovers ? 'm'
                   : kind == FieldInput::kPushed ? 'v'
                                                 : 'a';
  input(tag, now_ns, of_robot ? robot_id : -1, values);
}

void RecordingWriter::opponents_bytes(std::int64_t now_ns, std::span<const std::uint8_t> bytes) {
  if (!bytes.empty()) chunk('}', now_ns, bytes);
}

void RecordingWriter::world(std::int64_t now_ns, const World& world) {
  const BallState* const ball = world.ball();
  if (ball == nullptr || now_ns < next_ball_ns_) return;
  next_ball_ns_ = now_ns + kBallEvery_ns;
  const Vector3 &p = ball->position, &v = ball->velocity;
  const double values[] = {p.x(), p.y(), p.z(), v.x(), v.y(), v.z()};
  input('w', now_ns, -1, values);
}

void RecordingWriter::input(char tag, std::int64_t now_ns, int robot_id, std::span<const double> values) {
  if (error_) return;
  buffer_ += tag;
  buffer_ += ' ';
  append_integer(buffer_, now_ns);
  if (robot_id >= 0) {
    buffer_ += ' ';
    append_integer(buffer_, robot_id);
  }
  for (const double value : values) {
    buffer_ += ' ';
    append_number(buffer_, value);
  }
  end_line(now_ns);
}

void RecordingWriter::robot_tick(std::int64_t now_ns, const RobotSample& sample) {
  if (error_ || !decimation_.keep(sample.robot_id)) return;
  buffer_ += "s ";
  append_integer(buffer_, now_ns);
  buffer_ += ' ';
  append_integer(buffer_, sample.robot_id);
  for (const SampleColumn& column : sample_columns()) {
    buffer_ += ' ';
    append_number(buffer_, column.get(sample));
  }
  for (std::size_t i = 0; i < watched_; ++i) {
    buffer_ += ' ';
    append_number(buffer_, i < sample.watched.size() ? sample.watched[i] : 0.0);
  }
  end_line(now_ns);
}

void RecordingWriter::console_line(std::int64_t now_ns, int robot_id, int board, std::string_view port,
                                   std::string_view line) {
  if (error_) return;
  buffer_ += "t ";
  for (const std::int64_t number : {now_ns, std::int64_t{robot_id}, std::int64_t{board}}) {
    append_integer(buffer_, number);
    buffer_ += ' ';
  }
  buffer_ += port;
  buffer_ += ' ';
  buffer_ += line;
  end_line(now_ns);
}

void RecordingWriter::finish(const RecordingEnd& end) {
  if (error_) return;
  nlohmann::ordered_json counters = nlohmann::ordered_json::object();
  for (const auto& [name, count] : end.counters) counters[name] = count;
  const nlohmann::ordered_json line = {
      {"end", {{"now_ns", end.now_ns}, {"wall_s", end.wall_s}, {"counters", counters}}}};
  buffer_ += "# " + json_text(line) + "\n";
  flush();
}

void RecordingWriter::chunk(char tag, std::int64_t now_ns, std::span<const std::uint8_t> bytes) {
  if (error_) return;
  buffer_ += tag;
  buffer_ += ' ';
  append_integer(buffer_, now_ns);
  buffer_ += ' ';
  append_hex(buffer_, bytes);
  end_line(now_ns);
}

void RecordingWriter::end_line(std::int64_t now_ns) {
  buffer_ += '\n';
  if (buffer_.size() < kBuffer_bytes && now_ns - flushed_ns_ < kFlushEvery_ns) return;
  flushed_ns_ = now_ns;
  flush();
}

void RecordingWriter::flush() {
  if (!error_ && !buffer_.empty()) {
    if (const int error_number = write_all(fd_, buffer_); error_number != 0) {
      fail(error_number);
    } else {
      bytes_written_ += buffer_.size();
    }
  }
  buffer_.clear();
}

void RecordingWriter::fail(int error_number) {
  error_ = std::error_code(error_number, std::generic_category());
  if (report_) {
    report_("recording " + path_.string() + " stopped: " + error_.message() + "; the run goes on without it");
  }
}

}  // namespace omnihil
