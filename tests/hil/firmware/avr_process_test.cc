// The conversation with omnihil-avr about data memory: what is read and written, and what is refused.
#include "hil/firmware/avr_process.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>

namespace omnihil {
namespace {

// An ATmega328P has 32 registers, 224 input and output registers and 2048 bytes of RAM: 0 to 2303, RAM from 256 on.
class AvrConversation : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(OMNIHIL_BUILD_DIR "/tools/omnihil-avr"))
      GTEST_SKIP() << "no simavr: omnihil-avr was not built";
    process_ = std::make_unique<AvrProcess>(60.0);
    process_->send("chip atmega328p 16000000");
  }
  std::string answer(const std::string& line) {
    process_->send(line);
    std::string said;
    return process_->receive(said) ? said : "omnihil-avr " + process_->end();
  }
  // ldi r24, value; sts address, r24: two instructions of six bytes, 3 cycles.
  static std::string store(unsigned address, unsigned value) {
    return fmt::format("{:02x}{:02x}8093{:02x}{:02x}", 0x80 | (value & 15u), 0xE0 | value >> 4,
                       address & 255u, address >> 8);
  }
  std::unique_ptr<AvrProcess> process_;
};

TEST_F(AvrConversation, WhatIsWrittenIsReadAndPlacesComeOneBehindTheOther) {
  EXPECT_EQ(answer("write 256 0102fe"), "written");
  EXPECT_EQ(answer("write 2303 7f"), "written");
  EXPECT_EQ(answer("read 256 3"), "memory 0102fe");
  EXPECT_EQ(answer("read 258 1 2303 1 256 2 300 0"), "memory fe7f0102");
}

TEST_F(AvrConversation, BytesThatAreNotThereAreRefusedAndTheTalkGoesOn) {
  EXPECT_EQ(answer("write 256 33"), "written");
  for (const char* bad : {"read 2304 1", "read 2303 2", "read 256 1 4000000000 1", "read 0 4294967295",
                          "write 2303 0102", "write 255 01", "write 0 01", "write 4294967295 01"}) {
    EXPECT_EQ(answer(bad).substr(0, 8), "refused ") << bad;
  }
  EXPECT_NE(answer("read 2300 9").find("allowed: 0 to 2303"), std::string::npos);
  EXPECT_NE(answer("write 95 00").find("allowed: 256 to 2303"), std::string::npos);
  EXPECT_EQ(answer("read 256 1"), "memory 33");
}

TEST_F(AvrConversation, ALineThatIsNoneIsAnErrorAndTheEnd) {
  for (const char* bad :
       {"read", "read 256", "read 256 1 257", "read -1 1", "read 256 x", "write 256", "write 256 0",
        "write 256 zz", "write 256 00 00", "pause", "pause -1", "go_on", "bridge"}) {
    SetUp();
    EXPECT_EQ(answer(bad).substr(0, 6), "error ") << bad;
    EXPECT_EQ(answer("read 256 1"), "omnihil-avr ended with exit code 2") << bad;
  }
}

TEST_F(AvrConversation, ARunPausesOnceAtItsPlaceAndGoesOnToItsEnd) {
  // 0: [256] = 0x11; 6: [257] = 0x22; 12: rjmp 0
  process_->send("flash 0 " + store(256, 0x11) + store(257, 0x22) + "f9cf");
  EXPECT_EQ(answer("start"), "ready");
  process_->send("pause 6");
  EXPECT_EQ(answer("run 500000 0 0 0"), "paused");
  EXPECT_EQ(answer("read 256 2"), "memory 1100");
  EXPECT_EQ(answer("write 256 55"), "written");
  EXPECT_EQ(answer("go_on").substr(0, 5), "done ");
  EXPECT_EQ(answer("read 256 2"), "memory 1122");
  EXPECT_EQ(answer("run 1000000 500000 0 0").substr(0, 5), "done ");
}

TEST_F(AvrConversation, NoRunBeginsInsideAnother) {
  process_->send("flash 0 " + store(256, 0x11) + "fccf");
  EXPECT_EQ(answer("start"), "ready");
  process_->send("pause 0");
  EXPECT_EQ(answer("run 500000 0 0 0"), "paused");
  EXPECT_EQ(answer("run 500000 0 0 0").substr(0, 6), "error ");
}

}  // namespace
}  // namespace omnihil
