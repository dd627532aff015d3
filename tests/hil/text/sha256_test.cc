// FIPS 180-4, appendix B.1, and that pieces make the whole.
#include "hil/text/sha256.h"

#include <gtest/gtest.h>

namespace omnihil {
namespace {

TEST(Sha256Test, IsTheStandards) {
  constexpr const char* kOfAbc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
  Sha256 hash;
  hash.add("a");
  hash.add("");
  hash.add("bc");
  EXPECT_EQ(hash.hex(), kOfAbc);
  EXPECT_EQ(hash.hex(), kOfAbc);
  hash.add("d");
  EXPECT_NE(hash.hex(), kOfAbc);
}

}  // namespace
}  // namespace omnihil
