// Packets of a running bench for whoever connects to a Unix socket, as a pcap stream: what `convert --to pcap` writes, live.
//
//   std::error_code error;
//   auto feed = PacketFeed::open("/tmp/omnihil-capture", format, epoch_ms, error);
//   session.set_observer(feed.get());
//   feed->turn();                       // once per step: takes in new readers, hands on what they have room for
//
// A reader gets the packets from its connection on. One that reads too slowly is let go when kMostWaiting bytes wait
// for it, so that the bench never waits. Packets of the team alone, not of its opponents.
#pragma once
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "hil/loop/session.h"
#include "hil/recording/stream_frames.h"

namespace omnihil {

class PacketFeed : public SessionObserver {
 public:
  static constexpr std::size_t kMostWaiting = 4'000'000;  // bytes; choice: seconds of the busiest dongle

  // The socket's file is made anew and removed at the end. `epoch_ms`: Unix time at 0.
  static std::unique_ptr<PacketFeed> open(const std::string& path, const RadioFormat& format,
                                          std::uint64_t epoch_ms, std::error_code& error);
  ~PacketFeed() override;
  PacketFeed(const PacketFeed&) = delete;
  PacketFeed& operator=(const PacketFeed&) = delete;

  void host_bytes(std::int64_t now_ns, std::span<const std::uint8_t> bytes) override;
  void dongle_bytes(std::int64_t now_ns, std::span<const std::uint8_t> bytes) override;
  void turn();
  std::size_t readers() const { return readers_.size(); }

 private:
  struct Reader {
    int fd;
    std::string waiting;
  };

  PacketFeed(int fd, std::string path, const RadioFormat& format, std::uint64_t epoch_ms);
  void pass(FrameCutter& cutter, std::int64_t now_ns, std::span<const std::uint8_t> bytes);

  int fd_;
  std::string path_;
  std::uint64_t epoch_ms_;
  FrameCutter from_host_, to_host_;
  std::vector<Reader> readers_;
};

}  // namespace omnihil
