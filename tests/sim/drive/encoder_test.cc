#include "sim/drive/encoder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace omnihil {
namespace {

constexpr double kTurn_rad = 2.0 * std::numbers::pi;

EncoderParams encoder(int counts_per_turn, int direction = 1, int index_offset_counts = 0) {
  return {
      .counts_per_turn = counts_per_turn, .direction = direction, .index_offset_counts = index_offset_counts};
}

TEST(Encoder, OneTurnIsItsCountsPerTurn) {
  for (const int n : {1, 42, 4000, 4096, 8192, 20480}) {
    const EncoderParams e = encoder(n);
    const double within = 0.3 * kTurn_rad / n;  // away from an edge
    EXPECT_EQ(encoder_counts(e, within + kTurn_rad) - encoder_counts(e, within), n);
    EXPECT_EQ(encoder_counts(e, within - kTurn_rad) - encoder_counts(e, within), -n);
    EXPECT_EQ(encoder_counts(e, within + 1000 * kTurn_rad), 1000LL * n);
  }
}

TEST(Encoder, CountsChangeExactlyAtTheirEdges) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  for (const int n : {7, 4000, 4096, 8192}) {
    const EncoderParams e = encoder(n);
    for (std::int64_t counts : std::vector<std::int64_t>{-9'876'543'210, -8193, -2, -1, 0, 1, 2, 3, 4095,
                                                         4096, 1'234'567, 9'876'543'210}) {
      const double edge = encoder_edge_rad(e, counts);
      EXPECT_EQ(encoder_counts(e, edge), counts);
      EXPECT_EQ(encoder_counts(e, std::nextafter(edge, -kInf)), counts - 1);
    }
  }
}

TEST(Encoder, SmallNegativeAnglesCountDownFromZero) {
  EXPECT_EQ(encoder_counts(encoder(4096), -1e-12), -1);
  EXPECT_EQ(encoder_counts(encoder(4096), 0.0), 0);
  EXPECT_EQ(encoder_counts(encoder(4096), -0.0), 0);
}

TEST(Encoder, ReversedDirectionReadsTheOppositeAngle) {
  const EncoderParams forward = encoder(4096), backward = encoder(4096, -1);
  for (int n = -50; n <= 50; ++n) {
    const double angle = 0.0377 * n;
    EXPECT_EQ(encoder_counts(backward, angle), encoder_counts(forward, -angle));
  }
}

TEST(Encoder, LinesChangeOneAtATimeAndALeads) {
  const EncoderParams e = encoder(4096);
  const bool a[] = {false, true, true, false}, b[] = {false, false, true, true};
  for (std::int64_t counts = -8; counts < 8; ++counts) {
    const EncoderLines lines = encoder_lines(e, encoder_edge_rad(e, counts));
    const auto phase = static_cast<std::size_t>((counts + 8) % 4);
    EXPECT_EQ(lines.a, a[phase]) << counts;
    EXPECT_EQ(lines.b, b[phase]) << counts;
  }
}

TEST(Encoder, CountingTheLinesGivesTheCounts) {
  const EncoderParams e = encoder(400);
  const auto code = [](const EncoderLines& l) { return l.b ? (l.a ? 2 : 3) : (l.a ? 1 : 0); };
  double angle = -1.0;
  std::int64_t counted = encoder_counts(e, angle);
  int before = code(encoder_lines(e, angle));
  for (int n = 0; n < 2000; ++n) {  // back and forth, slower than one count per look
    angle += 0.01 * std::sin(0.01 * n);
    const int now = code(encoder_lines(e, angle));
    const int change = (now - before + 4) % 4;
    counted += change == 3 ? -1 : change;
    ASSERT_NE(change, 2);
    before = now;
  }
  EXPECT_EQ(counted, encoder_counts(e, angle));
}

TEST(Encoder, IndexIsHighForOneCountPerTurn) {
  const EncoderParams e = encoder(400, 1, 37);
  for (int turn = -2; turn <= 1; ++turn) {
    int high = 0;
    for (int n = 0; n < 400; ++n) {
      if (encoder_lines(e, encoder_edge_rad(e, turn * 400 + n)).index) {
        EXPECT_EQ(n, 37);
        ++high;
      }
    }
    EXPECT_EQ(high, 1);
  }
}

TEST(Encoder, IndexPulsesPassedAreTheRisingEdgesOnTheWay) {
  const EncoderParams e = encoder(40, 1, 5);
  for (std::int64_t from = -100; from <= 100; from += 3) {
    for (std::int64_t to = -100; to <= 100; to += 7) {
      std::int64_t seen = 0;
      const std::int64_t step = to >= from ? 1 : -1;
      for (std::int64_t n = from; n != to;) {
        n += step;
        seen += encoder_lines(e, encoder_edge_rad(e, n)).index ? 1 : 0;
      }
      EXPECT_EQ(index_pulses_between(e, encoder_edge_rad(e, from), encoder_edge_rad(e, to)), seen)
          << from << " to " << to;
    }
  }
}

TEST(Encoder, ManyTurnsBetweenTwoLooksShowOnePulsePerTurn) {
  const EncoderParams e = encoder(4096, -1, 100);
  EXPECT_EQ(index_pulses_between(e, 0.0, -10.0 * kTurn_rad), 10);
  EXPECT_EQ(index_pulses_between(e, 0.0, 10.0 * kTurn_rad), 10);
}

}  // namespace
}  // namespace omnihil
