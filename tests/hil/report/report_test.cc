// The HTML report of a diagnosis, as text: everything in it, nothing executable from outside, bounded.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "hil/report/report_assets.h"
#include "hil/report/report_charts.h"
#include "hil/report/report_orders.h"
#include "hil/report/report_text.h"
#include "hil/report/report_thin.h"
#include "tests/hil/report/sample.h"

namespace omnihil {
namespace {

constexpr std::size_t kMostBytes = 3'000'000;

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + what.size())) ++n;
  return n;
}

TEST(ReportThinTest, APeakOfOneSampleStaysItsFullHeight) {
  const ReportOverlay o = sample_overlay("run", Split::kTraining, "velocity", 20.0);
  const ThinClock clock = thin_clock(o.time_s, 100);
  const std::vector<double> thin = thinned(clock, o.measured);
  ASSERT_EQ(thin.size(), 200u);
  double greatest = -1e9, at_s = 0.0;
  for (std::size_t i = 0; i < thin.size(); ++i) {
    if (thin[i] > greatest) greatest = thin[i], at_s = clock.time_s[i];
  }
  EXPECT_EQ(greatest, kPeak_rad_s);
  EXPECT_NEAR(at_s, kPeakTime_s, 0.5 * clock.interval_s);
}

TEST(ReportThinTest, AShortSignalIsKeptSampleBySample) {
  const std::vector<double> t = {5.0, 5.1, 5.3}, y = {1.0, -2.0, 4.0};
  const ThinClock clock = thin_clock(t, 100);
  EXPECT_TRUE(clock.exact);
  EXPECT_EQ(thinned(clock, y), y);
  EXPECT_DOUBLE_EQ(clock.time_s[2], 5.3 - 5.0);
}

TEST(ReportThinTest, AnIntervalWithoutSamplesHasNoValue) {
  std::vector<double> t, y;
  for (int i = 0; i < 100; ++i) t.push_back(i < 50 ? i * 0.01 : 10.0 + i * 0.01), y.push_back(1.0);
  const ThinClock clock = thin_clock(t, 10);
  const std::vector<double> thin = thinned(clock, y);
  EXPECT_EQ(thin.front(), 1.0);
  EXPECT_EQ(thin.back(), 1.0);
  EXPECT_TRUE(std::isnan(thin[10]));  // the sixth of ten intervals of 1.1 s
}

TEST(ReportThinTest, PackingCodesRangeAndMissingValues) {
  // 0 is missing, 1 the least, 65535 the greatest: bytes 01 00 | 00 00 | ff ff
  const PackedSeries p = packed(std::vector<double>{-1.0, std::nan(""), 3.0});
  EXPECT_EQ(p.low, -1.0);
  EXPECT_EQ(p.high, 3.0);
  EXPECT_EQ(p.base64, "AQAAAP//");
}

TEST(ReportOrdersTest, AWaveOfOneOrderIsFoundWithItsAmplitude) {
  std::vector<double> angle, residual;
  for (int i = 0; i < 20000; ++i) {
    angle.push_back(2.0 * std::numbers::pi * 10.0 * (i / 20000.0) * (1.0 + i / 20000.0) /
                    2.0);  // ten turns, speeding up
    residual.push_back(0.7 + 0.25 * std::cos(12.0 * angle.back() + 1.0));
  }
  const OrderSums sums = order_sums(angle, residual, 30);
  const auto amplitude = [&](std::size_t n) { return std::sqrt(sums.power[n - 1] / sums.weight[n - 1]); };
  EXPECT_NEAR(sums.turns, 10.0, 0.01);
  EXPECT_NEAR(amplitude(12), 0.25, 0.001);
  EXPECT_LT(amplitude(11), 0.001);
  EXPECT_LT(amplitude(24), 0.001);
}

TEST(ReportOrdersTest, AWrappedAngleGivesTheSame) {
  std::vector<double> angle, wrapped, residual;
  for (int i = 0; i < 5000; ++i) {
    angle.push_back(0.01 * i);
    wrapped.push_back(std::remainder(0.01 * i, 2.0 * std::numbers::pi));
    residual.push_back(std::sin(3.0 * angle.back()));
  }
  const OrderSums a = order_sums(angle, residual, 5), b = order_sums(wrapped, residual, 5);
  EXPECT_NEAR(a.power[2], b.power[2], 1e-6 * a.power[2]);
}

TEST(ReportTest, NamesFromOutsideAreNeverMarkup) {
  const std::string html = report_html(sample_input());
  EXPECT_EQ(html.find("<img"), std::string::npos);
  EXPECT_EQ(html.find("<b>3</b>"), std::string::npos);
  // The elements that the page itself opens: JSON, uPlot (when built in), its own script.
  EXPECT_EQ(count(html, "</script>"), uplot_script().empty() ? 2u : 3u);
  EXPECT_NE(html.find("&lt;/script&gt;&lt;img"), std::string::npos);
}

TEST(ReportTest, NothingIsLoadedFromOutside) {
  const std::string html = report_html(sample_input());
  EXPECT_NE(html.find("default-src 'none'"), std::string::npos);
  for (const char* loader :
       {" src=", "@import", "url(http", "fetch(", "XMLHttpRequest", "<link rel=\"stylesheet"}) {
    const std::string own = html.substr(0, html.find("id=\"report-data\"")) + std::string(report_script());
    // The nasty name carries an escaped src of its own.
    EXPECT_EQ(count(own, loader), std::string(loader) == " src=" ? count(own, "&lt;img src=x") : 0u)
        << loader;
  }
}

TEST(ReportTest, EveryPartIsThere) {
  const std::string html = report_html(sample_input());
  for (const char* id : {"verdict", "ladder", "where", "overlays", "spectrum", "ranking", "parameters",
                         "data", "invisible", "next", "unknown", "about"}) {
    EXPECT_EQ(count(html, std::string("<section id=\"") + id + "\""), 1u) << id;
  }
  for (const char* said :
       {"The model lacks cogging", "lowers the held-out error by 82 %", "alike at one current", "0.0021",
        "one sample jumps by 12 rad/s", "Hold three currents", "the drive never reverses", "a &lt; b",
        "not determined by these data", "62 % of the error energy"}) {
    EXPECT_NE(html.find(said), std::string::npos) << said;
  }
}

TEST(ReportTest, TheVerdictSaysHowFarTheHeldOutErrorFell) {
  const Diagnosis d = sample_diagnosis();
  const double before = d.baseline_comparison.pooled(Split::kValidation),
               after = d.final_comparison.pooled(Split::kValidation);
  EXPECT_NE(verdict_sentence(d).find(figure(before) + " to " + figure(after)), std::string::npos)
      << verdict_sentence(d);
  EXPECT_NE(verdict_sentence(d).find(change_percent(before, after)), std::string::npos);
}

TEST(ReportTest, AFaultInTheDataComesBeforeTheVerdict) {
  Diagnosis d = sample_diagnosis();
  EXPECT_EQ(verdict_sentence(d).find("The data have faults"), 0u);
  d.findings.clear();
  EXPECT_EQ(verdict_sentence(d).find("The model lacks"), 0u);
}

TEST(ReportTest, AnInterruptedOrEmptyDiagnosisStillHasItsPage) {
  ReportInput empty;
  empty.diagnosis.complete = false;
  const std::string html = report_html(empty);
  EXPECT_NE(html.find("Interrupted"), std::string::npos);
  EXPECT_NE(html.find("No number was estimated"), std::string::npos);
  EXPECT_NE(html.find("</html>"), std::string::npos);
}

TEST(ReportTest, LongAndManyRecordingsStayBelowThreeMegabytes) {
  ReportInput in = sample_input();
  in.overlays.clear();
  for (int i = 0; i < 8; ++i)
    in.overlays.push_back(sample_overlay("long.csv", Split::kTraining, "velocity", 200.0));
  EXPECT_LT(report_html(in).size(), kMostBytes);
  in.overlays.clear();
  for (int i = 0; i < 600; ++i)
    in.overlays.push_back(sample_overlay("run" + std::to_string(i), Split::kTraining, "velocity", 2.0));
  EXPECT_LT(report_html(in).size(), kMostBytes);
  const auto data = nlohmann::json::parse(chart_data(in));
  EXPECT_EQ(data["overlays"].size() + data["overlays_left_out"].get<std::size_t>(), 600u);
  EXPECT_GT(data["overlays_left_out"].get<std::size_t>(), 0u);
}

TEST(ReportTest, TheSameInputGivesTheSameBytes) {
  EXPECT_EQ(report_html(sample_input(2.0)), report_html(sample_input(2.0)));
}

TEST(ReportTest, TheWorstRegimeIsTheOneWithMostErrorForItsTime) {
  const auto data = nlohmann::json::parse(chart_data(sample_input(2.0)));
  ASSERT_FALSE(data["maps"].empty());
  EXPECT_EQ(data["maps"][0]["worst"], 10);  // 62 % of the error in 5 % of the time
}

}  // namespace
}  // namespace omnihil
