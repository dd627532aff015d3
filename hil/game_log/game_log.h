// The league's game logs: what vision and referee sent during a match, message by message, as the receiver had them.
//
//   GameLogReader log("2024-07-20_final.log.gz");             // throws BadCapture, std::system_error
//   GameLogRecord record;
//   while (log.next(record)) …                                 // record.kind, record.received_ns, record.bytes
//   for (const std::string& note : log.notes()) …              // "final.log.gz:record 812: the log is cut …"
//
// A file begins with "SSL_LOG_FILE" and a version, 1; then records: time of receipt in ns (8 bytes), kind (4), length (4), a
// message of protobuf; all numbers most significant first. Packed by gzip or not. An index ends it. A file that ends inside a
// record, or has a length that cannot be, is read up to there, and this is said.
// Source: RoboCup-SSL/ssl-logtools and ssl-go-tools (pkg/persistence), which write and read them.
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "hil/capture/captured.h"

struct gzFile_s;

namespace omnihil {

enum class GameLogKind : std::int32_t {
  kBlank = 0,
  kUnknown = 1,  // the reader is to guess
  kVision2010 = 2,
  kReferee2013 = 3,
  kVision2014 = 4,
  kTracker2020 = 5,
  kIndex2021 = 6,
};

struct GameLogRecord {
  GameLogKind kind = GameLogKind::kBlank;  // kinds to come are passed on as they are
  std::int64_t received_ns = 0;
  std::string bytes;
};

bool is_game_log(const std::filesystem::path& path);

class GameLogReader {
 public:
  explicit GameLogReader(const std::filesystem::path& path);
  bool next(GameLogRecord& record);
  std::size_t records() const { return records_; }
  std::vector<std::string> notes() const { return notes_.list(); }
  CaptureNotes& more_notes() { return notes_; }  // of who reads the messages, by record

 private:
  bool read(void* to, std::size_t count);

  std::unique_ptr<gzFile_s, int (*)(gzFile_s*)> file_;
  CaptureNotes notes_;
  std::size_t records_ = 0;
};

}  // namespace omnihil
