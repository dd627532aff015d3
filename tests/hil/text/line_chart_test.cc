// Curves that are there, peaks that stay peaks, gaps where there is no value.
#include "hil/text/line_chart.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <regex>

namespace omnihil {
namespace {

std::size_t count_of(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

// The y of every point of the picture's first curve, in pixels.
std::vector<double> heights(const std::string& svg) {
  const std::size_t at = svg.find("points=\"");
  EXPECT_NE(at, std::string::npos);
  const std::string points = svg.substr(at + 8, svg.find('"', at + 8) - at - 8);
  std::vector<double> y;
  const std::regex pair("([-0-9.]+),([-0-9.]+)");
  for (std::sregex_iterator i(points.begin(), points.end(), pair), end; i != end; ++i)
    y.push_back(std::stod((*i)[2]));
  return y;
}

LineChart chart_of(std::vector<double> y) {
  LineChart chart;
  chart.title = "a < b";
  for (std::size_t i = 0; i < y.size(); ++i) chart.x.push_back(0.001 * static_cast<double>(i));
  chart.panels.push_back({"rad/s", {{"recorded", std::move(y)}}});
  return chart;
}

TEST(LineChart, DrawsEveryValueOfAShortCurve) {
  const std::string svg = line_chart(chart_of({0.0, 1.0, 2.0, 1.0}));
  EXPECT_EQ(count_of(svg, "<polyline"), 1U);
  const auto y = heights(svg);
  ASSERT_EQ(y.size(), 4U);
  EXPECT_LT(y[2], y[1]);  // higher values stand higher: smaller y
  EXPECT_LT(y[1], y[0]);
  EXPECT_EQ(y[1], y[3]);
  EXPECT_NE(svg.find("a &lt; b"), std::string::npos);
}

TEST(LineChart, OnePeakInALongRecordStays) {
  std::vector<double> y(50'000, 0.0);
  y[31'234] = 5.0;
  const auto drawn = heights(line_chart(chart_of(y)));
  EXPECT_LT(drawn.size(), 3'000U);
  EXPECT_GT(*std::ranges::max_element(drawn) - *std::ranges::min_element(drawn), 150.0);  // of 190 pixels
}

TEST(LineChart, WhatIsNotFiniteIsAGap) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(count_of(line_chart(chart_of({0.0, 1.0, none, 2.0, 3.0})), "<polyline"), 2U);
  EXPECT_EQ(count_of(line_chart(chart_of({none, none})), "<polyline"), 0U);
}

}  // namespace
}  // namespace omnihil
