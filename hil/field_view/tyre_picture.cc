#include "hil/field_view/tyre_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "hil/text/markup.h"

namespace omnihil {
namespace {

constexpr double kWidth = 760, kHeight = 480, kLeft = 70, kRight = 20, kTop = 40, kBottom = 50;
constexpr std::size_t kMostPoints = 3000;  // drawn

struct Axes {
  double slip, ratio;  // largest of each
  double x(double s) const { return kLeft + (s / slip + 1.0) / 2.0 * (kWidth - kLeft - kRight); }
  double y(double r) const { return kTop + (1.0 - r / ratio) / 2.0 * (kHeight - kTop - kBottom); }
};

double round_up(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double part : {1.0, 2.0, 5.0, 10.0})
    if (part * power >= value) return part * power;
  return 10.0 * power;
}

Axes axes_of(const TyreIdentification& t) {
  std::vector<double> slips, ratios;
  for (const TyrePoint& p : t.points.all) {
    slips.push_back(std::abs(p.slip));
    ratios.push_back(std::abs(p.ratio));
  }
  const auto most = [](std::vector<double>& v, double share) {
    if (v.empty()) return 1.0;
    const auto at = v.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(v.size() - 1));
    std::nth_element(v.begin(), at, v.end());
    return std::max(1e-6, *at);
  };
  return {round_up(most(slips, 0.98)), round_up(1.1 * most(ratios, 0.995))};
}

}  // namespace

std::string tyre_picture(const TyreIdentification& t, const std::string& title) {
  const Axes a = axes_of(t);
  std::string svg;
  const auto out = std::back_inserter(svg);
  fmt::format_to(
      out,
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
      "{1:.0f}\" font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" "
      "fill=\"#ffffff\"/>\n<text x=\"{2:.0f}\" y=\"22\" font-size=\"15\">{3}</text>\n",
      kWidth, kHeight, kLeft, escaped(title));
  for (int k = -2; k <= 2; ++k) {
    const double s = 0.5 * k * a.slip, r = 0.5 * k * a.ratio;
    fmt::format_to(
        out,
        "<path d=\"M{:.1f} {} V{} M{} {:.1f} H{}\" stroke=\"#ddd\"/>\n<text x=\"{:.1f}\" y=\"{:.0f}\" "
        "text-anchor=\"middle\">{:.3g}</text>\n<text x=\"{:.0f}\" y=\"{:.1f}\" text-anchor=\"end\">{:.3g}"
        "</text>\n",
        a.x(s), kTop, kHeight - kBottom, kLeft, a.y(r), kWidth - kRight, a.x(s), kHeight - kBottom + 16, s,
        kLeft - 6, a.y(r) + 4, r);
  }
  fmt::format_to(
      out,
      "<text x=\"{:.0f}\" y=\"{:.0f}\" text-anchor=\"middle\">slip, eq. (6), positive where the wheel "
      "drives</text>\n<text transform=\"translate(18 {:.0f}) rotate(-90)\" text-anchor=\"middle\">force over "
      "wheel load</text>\n",
      0.5 * (kLeft + kWidth - kRight), kHeight - 12, 0.5 * (kTop + kHeight - kBottom));
  const std::size_t stride = 1 + t.points.all.size() / kMostPoints;
  for (std::size_t i = 0; i < t.points.all.size(); i += stride) {
    const TyrePoint& p = t.points.all[i];
    if (std::abs(p.slip) > a.slip || std::abs(p.ratio) > a.ratio) continue;
    fmt::format_to(out,
                   "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"1.5\" fill=\"#1f6feb\" fill-opacity=\"0.25\"/>\n",
                   a.x(p.slip), a.y(p.ratio));
  }
  for (const TyreBin& bin : tyre_bins(t.points.all)) {
    if (std::abs(bin.slip) > a.slip || std::abs(bin.ratio) > a.ratio) continue;
    fmt::format_to(
        out,
        "<path d=\"M{0:.1f} {1:.1f} V{2:.1f}\" stroke=\"#000\"/><circle cx=\"{0:.1f}\" cy=\"{3:.1f}\" "
        "r=\"3\" fill=\"#000\"/>\n",
        a.x(bin.slip), a.y(bin.ratio - 2.0 * bin.ratio_error), a.y(bin.ratio + 2.0 * bin.ratio_error),
        a.y(bin.ratio));
  }
  if (t.outcome == TyreOutcome::kNothing) return svg + "</svg>\n";
  const TyreCurve curve = t.curve();
  constexpr int kSteps = 400;
  std::string middle, upper, lower;
  for (int k = 0; k <= kSteps; ++k) {
    const double s = a.slip * (2.0 * k / kSteps - 1.0), r = grip<double>(curve, s), b = t.band(s);
    const auto put = [&](std::string& path, double ratio) {
      fmt::format_to(std::back_inserter(path), "{:.1f},{:.1f} ", a.x(s),
                     a.y(std::clamp(ratio, -a.ratio, a.ratio)));
    };
    put(middle, r);
    put(upper, r + b);
    std::string one;
    put(one, r - b);
    lower.insert(0, one);
  }
  fmt::format_to(out, "<polygon points=\"{}{}\" fill=\"#d33\" fill-opacity=\"0.3\"/>\n", upper, lower);
  fmt::format_to(out, "<polyline points=\"{}\" fill=\"none\" stroke=\"#d33\" stroke-width=\"2\"/>\n", middle);
  return svg + "</svg>\n";
}

}  // namespace omnihil
