// What is made again, and what is not.
#include "identify/record/remembered.h"

#include <gtest/gtest.h>

namespace omnihil {
namespace {

TEST(Remembered, MakesTheSameOnceAndTheOldestAnew) {
  Remembered<double, int> kept(2);
  int made = 0;
  const auto ask = [&](double key) { return *kept.of(key, [&] { return ++made; }); };
  EXPECT_EQ(ask(1.0), 1);
  EXPECT_EQ(ask(2.0), 2);
  EXPECT_EQ(ask(1.0), 1);
  EXPECT_EQ(ask(3.0), 3);  // in place of what was asked for longest ago
  EXPECT_EQ(ask(1.0), 1);
  EXPECT_EQ(ask(2.0), 4);
}

}  // namespace
}  // namespace omnihil
