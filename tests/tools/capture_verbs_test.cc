// Captures of other tools at the command line: what import, dump and convert make of them.
#include <gtest/gtest.h>

#include "hil/capture/asc.h"
#include "hil/capture/candump.h"
#include "hil/capture/pcapng.h"
#include "hil/capture/timed_csv.h"
#include "hil/recording/capture_import.h"
#include "hil/recording/recorded_packets.h"
#include "hil/recording/recording_reader.h"
#include "tests/hil/capture/pcap_builder.h"
#include "tests/hil/recording/real_run.h"
#include "tests/tools/cli.h"

namespace omnihil {
namespace {

struct Packet {
  bool from_host = false;
  std::int64_t unix_ns = 0;
  std::vector<std::uint8_t> bytes;
  bool operator==(const Packet&) const = default;
};

std::vector<Packet> packets_in(const Recording& recording) {
  std::vector<Packet> packets;
  for (const PassedPacket& passed : all_packets(recording, *find_radio_format(recording.header.radio_format)))
    packets.push_back(
        {passed.from_host,
         static_cast<std::int64_t>(recording.header.epoch_ms) * 1'000'000 + passed.packet.now_ns,
         passed.packet.frame.bytes});
  return packets;
}

class CaptureVerbs : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    if (IsSkipped()) return;
    for (const real::Case& each : {real::kHermes, real::kRem}) {
      names_.push_back(each.robot);
      runs_.push_back(real::record(real::setup(each), 600));
      fake::write_text(file("run" + std::to_string(runs_.size() - 1) + ".omnirec"),
                       real::text_of(runs_.back()));
    }
  }
  std::filesystem::path file(const std::string& name) const { return folder_ / name; }

  fake::TempFolder folder_;
  std::vector<Recording> runs_;
  std::vector<std::string> names_;
};

// What passed is the same after a way through each form; by candump and asc to the microsecond.
TEST_F(CaptureVerbs, WhatIsConvertedIsImportedAgain) {
  for (std::size_t k = 0; k < runs_.size(); ++k) {
    const std::string number = std::to_string(k);
    const std::vector<Packet> before = packets_in(load_recording(file("run" + number + ".omnirec")));
    ASSERT_GT(before.size(), 50U);
    for (const std::string form : {"pcapng", "pcap", "candump", "asc"}) {
      const auto capture = file("run" + number + "." + form), back = file("back" + number + "." + form);
      const Ran made = run_omnihil("convert" + shell(file("run" + number + ".omnirec")) + "--to " + form +
                                   " --out" + shell(capture));
      ASSERT_EQ(made.exit_code, 0) << made.text;
      const Ran imported = run_omnihil("import" + shell(capture) + "--robots 0,3 --robot " + names_[k] +
                                       " --out" + shell(back));
      ASSERT_EQ(imported.exit_code, 0) << imported.text;
      std::vector<Packet> after = packets_in(load_recording(back));
      ASSERT_EQ(after.size(), before.size()) << form << imported.text;
      const std::int64_t grid_ns = form == "candump" || form == "asc" ? 1000 : 1;
      for (std::size_t i = 0; i < after.size(); ++i) {
        EXPECT_EQ(after[i].from_host, before[i].from_host) << form << i;
        EXPECT_EQ(after[i].bytes, before[i].bytes) << form << i;
        EXPECT_EQ(after[i].unix_ns, before[i].unix_ns / grid_ns * grid_ns) << form << i;
      }
      EXPECT_EQ(imported.says("does not say which way"), form == "pcap") << imported.text;
    }
  }
}

TEST_F(CaptureVerbs, DumpPrintsACaptureAsTheRecordingItCameFrom) {
  const auto capture = file("run.pcapng");
  ASSERT_EQ(
      run_omnihil("convert" + shell(file("run0.omnirec")) + "--to pcapng --out" + shell(capture)).exit_code,
      0);
  const Ran recording = run_omnihil("dump --packet BATTERIE_RESPONSE" + shell(file("run0.omnirec")));
  const Ran packets = run_omnihil("dump --packet BATTERIE_RESPONSE --radio ulaval-hermes" + shell(capture));
  EXPECT_EQ(packets.exit_code, 0) << packets.text;
  // Below the head the same lines; time 0 is a whole millisecond in both.
  const auto words = [](const Ran& ran) {
    std::vector<std::string> found;
    for (std::size_t at = 0; (at = ran.text.find("< {", at)) != std::string::npos; ++at)
      found.push_back(ran.text.substr(at, ran.text.find('\n', at) - at));
    return found;
  };
  EXPECT_FALSE(words(packets).empty());
  EXPECT_EQ(words(packets), words(recording));
  const Ran hex = run_omnihil("dump" + shell(capture));
  EXPECT_EQ(hex.exit_code, 0) << hex.text;
  EXPECT_TRUE(hex.says("0.000000 > ")) << hex.text;
  EXPECT_EQ(run_omnihil("dump --packet BATTERIE_RESPONSE" + shell(capture)).exit_code, 2);
  EXPECT_TRUE(run_omnihil("dump --robot 3" + shell(capture)).says("--radio: found none"));
}

TEST_F(CaptureVerbs, NotesNameTheFileAndTheLine) {
  fake::write_text(file("bus.log"),
                   "(1700000000.000000) can0 7E0#0301FE03\r\n(1700000000.001000) can0 123#R\r\n"
                   "(1700000000.002000) can1 7E8#0102\r\nhello\r\n(1700000000.003000) can0 7E0#03");
  const Ran ran = run_omnihil("import --robot ulaval_delta" + shell(file("bus.log")) + "--out" +
                              shell(file("bus.omnirec")));
  EXPECT_EQ(ran.exit_code, 0) << ran.text;
  for (const char* note :
       {"note: ", "bus.log:2: remote frame: left out", "bus.log:4: no frame of candump: left out",
        "bus.log:5: the last line is cut: left out", "bus.log: lines end with CR LF", "can0, can1"})
    EXPECT_TRUE(ran.says(note)) << ran.text;
  EXPECT_EQ(load_recording(file("bus.omnirec")).header.epoch_ms, 1'700'000'000'000U);
  EXPECT_EQ(load_recording(file("bus.omnirec")).chunks.size(), 2U);
}

TEST_F(CaptureVerbs, OneTalkOfSeveralIsChosenByItsPort) {
  using namespace peers;
  const auto by = [](int from, int to) { return ethernet(ipv4(udp(from, to, "abc"))); };
  fake::write_text(file("lan.pcap"),
                   pcap_file(true, false, 1, {by(40'000, 10'301), by(5, 6), by(10'301, 40'000)}));
  const std::string out = "--robot ulaval_delta --out" + shell(file("lan.omnirec"));
  const Ran none = run_omnihil("import" + shell(file("lan.pcap")) + out);
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_TRUE(
      none.says("lan.pcap: UDP port of the dongle: found none, allowed: 6 (1 packets), 10301 (1 packets)"))
      << none.text;
  const Ran one = run_omnihil("import --udp-port 10301" + shell(file("lan.pcap")) + out);
  EXPECT_EQ(one.exit_code, 0) << one.text;
  EXPECT_TRUE(one.says("1 writes of the host, 1 of the robots")) << one.text;
  const Ran dumped = run_omnihil("dump" + shell(file("lan.pcap")));
  EXPECT_TRUE(dumped.says("0.001000 ? udp 5 to 6 616263")) << dumped.text;
  EXPECT_EQ(run_omnihil("import --can-id 7x" + shell(file("lan.pcap")) + out).exit_code, 2);
}

TEST_F(CaptureVerbs, CapturesBecomeOneAnother) {
  const std::vector<Captured> pieces = as_can_frames(pieces_of(runs_[0]));
  fake::write_text(file("a.log"), write_candump(pieces, "can0"));
  const auto made = [&](const std::string& from, const std::string& to) {
    const Ran ran =
        run_omnihil("convert" + shell(file(from)) + "--to " + to + " --out" + shell(file("a." + to)));
    EXPECT_EQ(ran.exit_code, 0) << ran.text;
  };
  made("a.log", "asc");
  made("a.asc", "csv");
  made("a.csv", "pcapng");
  made("a.pcapng", "candump");
  EXPECT_EQ(fake::read_text(file("a.candump")), fake::read_text(file("a.log")));
  made("a.candump", "stream");
  EXPECT_EQ(run_omnihil("convert" + shell(file("a.log")) + "--to asc --out" + shell(file("a.asc"))).exit_code,
            2);
  const Ran dataset = run_omnihil("convert" + shell(file("a.log")) + "--to dataset --out" + shell(file("d")));
  EXPECT_EQ(dataset.exit_code, 2);
  EXPECT_TRUE(dataset.says("--to: found dataset, allowed for a capture: candump, asc, csv, pcapng, stream"))
      << dataset.text;
}

// CSV without a column for the way: the packets say it, where their format is given.
TEST_F(CaptureVerbs, PiecesWithoutAWayNeedTheRadioFormat) {
  std::vector<Captured> pieces = packets_of(runs_[1], *find_radio_format(runs_[1].header.radio_format));
  for (Captured& each : pieces) each.way = CaptureWay::kUnknown;
  fake::write_text(file("uart.csv"), write_timed_csv(pieces));
  const std::string convert =
      "convert" + shell(file("uart.csv")) + "--to stream --out" + shell(file("uart.txt"));
  const Ran without = run_omnihil(convert);
  EXPECT_EQ(without.exit_code, 2);
  EXPECT_TRUE(without.says("--radio: found none, allowed: the format of the packets")) << without.text;
  const Ran with = run_omnihil(convert + "--radio " + runs_[1].header.radio_format);
  EXPECT_EQ(with.exit_code, 0) << with.text;
  std::size_t from_host = 0;
  for (const Packet& each : packets_in(runs_[1])) from_host += each.from_host ? 1 : 0;
  EXPECT_TRUE(with.says(std::to_string(from_host) + " writes")) << with.text;
}

}  // namespace
}  // namespace omnihil
