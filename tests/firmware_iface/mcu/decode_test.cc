// Encodings that exist and their neighbours that do not, by hand from the manual; the differential test does
// the rest.
#include "firmware_iface/mcu/core/decode.h"

#include <gtest/gtest.h>

namespace omnihil::mcu {
namespace {

struct Encoding {
  std::uint16_t h, g;
  const char* what;
};

Code code_of(const Encoding& e, const Variant& variant, std::uint8_t it = 0) {
  return decode({0x08000000, variant, it}, e.h, e.g).code;
}

TEST(DecodeTest, WhatTheManualCallsUnpredictableIsUndefined) {
  constexpr Encoding kForms[] = {
      {0xB400, 0, "PUSH of nothing"},
      {0xC800, 0, "LDM of nothing"},
      {0xE8B0, 0x0002, "LDM.W of one register"},
      {0xE8B0, 0x0003, "LDM with write-back of its base"},
      {0xE8B0, 0xC006, "LDM of PC and LR"},
      {0xE8A0, 0x2006, "STM of SP"},
      {0xE9D0, 0x1100, "LDRD to one register twice"},
      {0xE9F1, 0x1200, "LDRD with write-back to its base"},
      {0xE840, 0x1001, "STREX whose status is its address"},
      {0xF850, 0x0F04, "LDR with write-back to its base"},
      {0xF81D, 0xDB01, "LDRB to SP"},
      {0xEA0D, 0x0001, "AND of SP"},
      {0xEA00, 0x0D01, "AND to SP"},
      {0xF000, 0x1000, "modified immediate of a repeated zero"},
      {0xF360, 0x1000, "BFI with msb below lsb"},
      {0xF340, 0x7F1F, "SBFX beyond bit 31"},
      {0xFBA0, 0x1102, "UMULL with one destination twice"},
      {0xFAB0, 0xF181, "CLZ of two registers"},
      {0x4508, 0, "CMP of PC-less low registers in the high form"},
      {0x4787, 0, "BLX with its zero bits set"},
      {0xEEBA, 0x0A6C, "VCVT with 25 of 16 fraction bits"},
      {0xEC51, 0x1B10, "VMOV of a pair to one register"},
      {0xECB0, 0x0A00, "VLDM of nothing"},
      {0xED00, 0x0F01, "VSTR of coprocessor 15"},
      {0xF380, 0x8900, "MSR of a register that is not there"},
  };
  for (const Encoding& e : kForms) {
    const Code code = code_of(e, kCortexM7);
    EXPECT_TRUE(code == kUndefined || code == kNoCoprocessor) << e.what << " is " << op_name(code);
  }
}

TEST(DecodeTest, TheirNeighboursExist) {
  const std::pair<Encoding, Code> kForms[] = {
      {{0xB401, 0, ""}, kPush},
      {{0xE8B0, 0x0006, ""}, kLdm},
      {{0xE9D0, 0x1200, ""}, kLdrd},
      {{0xE840, 0x1200, ""}, kStrex},
      {{0xF850, 0x1F04, ""}, kLdrPre},
      {{0xEA00, 0x0001, ""}, kAndReg},
      {{0xF360, 0x0007, ""}, kBfi},
      {{0xFBA0, 0x1202, ""}, kUmull},
      {{0xFAB1, 0xF181, ""}, kClz},
      {{0x4588, 0, ""}, kCmpReg},
      {{0x4788, 0, ""}, kBlx},
      {{0xEEBA, 0x0A44, ""}, kVcvtFromFixedF32},
      {{0xEC52, 0x1B10, ""}, kVmovFromPair},
      {{0xECB0, 0x0A01, ""}, kVldm},
      {{0xF380, 0x8811, ""}, kMsr},
      {{0xEE30, 0x0B00, ""}, kVaddF64},
      {{0xFE00, 0x0A00, ""}, kVselF32},
  };
  for (const auto& [e, code] : kForms) {
    const Code found = code_of(e, kCortexM7);
    EXPECT_EQ(found, code) << op_name(code) << " is " << op_name(found);
  }
}

TEST(DecodeTest, EachVariantHasItsOwnInstructions) {
  constexpr Encoding kSmladForm = {0xFB20, 0x3201, "SMLAD"}, kSdivide = {0xFB90, 0xF1F2, "SDIV"},
                     kCbzForm = {0xB108, 0, "CBZ"};
  constexpr Encoding kVadd = {0xEE30, 0x0A00, "VADD.F32"}, kVaddDouble = {0xEE30, 0x0B00, "VADD.F64"};
  constexpr Encoding kVselForm = {0xFE00, 0x0A00, "VSEL"}, kBlForm = {0xF000, 0xF800, "BL"};
  EXPECT_EQ(code_of(kSmladForm, kCortexM4), kSmlad);
  EXPECT_EQ(code_of(kSmladForm, kCortexM3), kUndefined);
  EXPECT_EQ(code_of(kSdivide, kCortexM3), kSdiv);
  EXPECT_EQ(code_of(kSdivide, kCortexM0), kUndefined);
  EXPECT_EQ(code_of(kCbzForm, kCortexM3), kCbz);
  EXPECT_EQ(code_of(kCbzForm, kCortexM0), kUndefined);
  EXPECT_EQ(code_of(kBlForm, kCortexM0), kBl);
  EXPECT_EQ(code_of(kVadd, kCortexM4F), kVaddF32);
  EXPECT_EQ(code_of(kVadd, kCortexM4), kNoCoprocessor);
  EXPECT_EQ(code_of(kVaddDouble, kCortexM4F), kUndefined);
  EXPECT_EQ(code_of(kVaddDouble, kCortexM7), kVaddF64);
  EXPECT_EQ(code_of(kVselForm, kCortexM4F), kUndefined);
  EXPECT_EQ(code_of(kVselForm, kCortexM7Single), kVselF32);
}

TEST(DecodeTest, ItBlocksBakeTheirConditionIn) {
  // ITSTATE EQ with two to come, of which the second is the last.
  const std::uint8_t first = 0x0C, last = it_next(first);
  EXPECT_EQ(decode({0, kCortexM4F, first}, 0x1840, 0).code, kAddReg);  // ADDS without its flags
  EXPECT_EQ(decode({0, kCortexM4F, 0}, 0x1840, 0).code, kAddRegS);
  EXPECT_EQ(decode({0, kCortexM4F, last}, 0x1840, 0).condition, 1);  // the E of ITE
  EXPECT_EQ(it_next(last), 0);
  EXPECT_EQ(decode({0, kCortexM4F, first}, 0xE7FE, 0).code, kUndefined);  // a branch in the middle
  EXPECT_EQ(decode({0, kCortexM4F, last}, 0xE7FE, 0).code, kB);
  EXPECT_EQ(decode({0, kCortexM4F, last}, 0xB108, 0).code, kUndefined);  // CBZ nowhere in it
}

}  // namespace
}  // namespace omnihil::mcu
