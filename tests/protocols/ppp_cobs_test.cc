#include "protocols/ppp_cobs.h"

#include <random>

#include "firmware_iface/checksum.h"
#include "tests/protocols/packet_util.h"

namespace omnihil {
namespace {

Bytes stuffed(const Bytes& data) {
  Bytes out;
  ppp_cobs_encode(data, out);
  return out;
}

TEST(PppCobs, ZerosAreShortened) {
  EXPECT_EQ(to_hex(stuffed(from_hex("0500000000000045"))), "e105d40245");
  EXPECT_EQ(to_hex(stuffed({})), "01") << "the zero at the end alone";
  EXPECT_EQ(to_hex(stuffed(Bytes(1, 0))), "e0");
  EXPECT_EQ(to_hex(stuffed(Bytes(14, 0))), "df");
  EXPECT_EQ(to_hex(stuffed(Bytes(15, 0))), "df01");
  EXPECT_EQ(stuffed(Bytes(209, 7)).size(), 1u + 209u + 1u) << "D2, the bytes, and the zero";
}

TEST(PppCobs, ComesBackAndHoldsNoZero) {
  std::mt19937 random(7);
  for (int i = 0; i < 2000; ++i) {
    Bytes data(random() % 600);
    const unsigned zeros_of_256 = random() % 257;
    for (std::uint8_t& byte : data) {
      byte = static_cast<std::uint8_t>(random() % 256 < zeros_of_256 ? 0 : random());
    }
    const Bytes out = stuffed(data);
    EXPECT_EQ(std::count(out.begin(), out.end(), 0), 0);
    EXPECT_EQ(ppp_cobs_decode(out), data);
  }
}

TEST(PppCobs, CodesThatDoNotFitAreRefused) {
  for (const char* bad : {"", "00", "05aabb", "ff", "03aa00", "d2"})
    EXPECT_FALSE(ppp_cobs_decode(from_hex(bad))) << bad;
  EXPECT_EQ(ppp_cobs_decode(from_hex("02aa")), Bytes{0xAA});
}

// 42 bytes on the air: id (bit 5 broadcast, bit 6 from the base station), sequence, what was lost, 39 of the stream.
TEST(PppCobs, TheTeamsAirPacketsBothWays) {
  const std::string shared = shared_folder();
  if (shared.empty()) GTEST_SKIP() << "OMNIHIL_SHARED does not name the folder of reference data";
  const nlohmann::json file = read_json(shared + "/vectors/tigers-base-station.json");
  int rows = 0;
  for (const char* group : {"match_ctrl", "match_feedback", "broadcast", "codec"}) {
    for (const nlohmann::json& row : file.at(group)) {
      Bytes packet = from_hex(row.at("app"));
      const std::uint32_t crc = crc16_xmodem(packet);
      packet.push_back(static_cast<std::uint8_t>(crc));
      packet.push_back(static_cast<std::uint8_t>(crc >> 8));
      Bytes stream = stuffed(packet);
      EXPECT_EQ(ppp_cobs_decode(stream), packet);
      stream.push_back(0);
      EXPECT_EQ(to_hex(stream), row.at("encoded").get<std::string>());
      Bytes from_air;
      for (const nlohmann::json& piece : row.at("air")) {
        const Bytes air = from_hex(piece);
        ASSERT_EQ(air.size(), 42u);
        from_air.insert(from_air.end(), air.begin() + 3, air.end());
      }
      stream.resize(from_air.size());
      EXPECT_EQ(to_hex(from_air), to_hex(stream)) << "the rest is zeros";
      ++rows;
    }
  }
  EXPECT_EQ(rows, 16 + 12 + 10 + 30);
  std::printf("tigers-base-station: %d packets on the air both ways\n", rows);
}

}  // namespace
}  // namespace omnihil
