#include "hil/card/validity_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hil/report/report_text.h"

namespace omnihil {
namespace {

constexpr double kCell = 46, kRow = 26, kLeft = 78, kTop = 8, kBelow = 40;

// Per cent of the signal's spread; NaN: not tested.
double percent_of(const ValidityMap& map, const ValidityCell& cell) {
  return map.spread > 0.0 ? 100.0 * cell.rmse / map.spread : std::nan("");
}

std::string cell_svg(const ValidityMap& map, std::size_t column, std::size_t row, double largest) {
  const ValidityCell& cell = map.at(column, row);
  if (cell.fitted + cell.unseen == 0) return "";
  const double x = kLeft + kCell * static_cast<double>(column);
  const double y = kTop + kRow * static_cast<double>(map.rows() - 1 - row);
  const double percent = percent_of(map, cell);
  std::string out = fmt::format(
      "<g><title>{} {} to {} {}, {} {} to {} {}: {} samples unseen, {} fitted{}</title>", escaped(map.x.name),
      figure(map.x.edges[column]), figure(map.x.edges[column + 1]), escaped(map.x.unit), escaped(map.y.name),
      figure(map.y.edges[row]), figure(map.y.edges[row + 1]), escaped(map.y.unit), cell.unseen, cell.fitted,
      std::isfinite(cell.rmse) ? fmt::format("; rms error {} {}, mean {} {}", figure(cell.rmse),
                                             escaped(map.unit), figure(cell.bias), escaped(map.unit))
                               : "");
  const bool tested = std::isfinite(percent);
  out += fmt::format(
      "<rect x=\"{:.0f}\" y=\"{:.0f}\" width=\"{:.0f}\" height=\"{:.0f}\" "
      "style=\"fill:var(--c-orange);fill-opacity:{:.2f};"
      "stroke:var(--c-soft);stroke-dasharray:{}\"/>",
      x + 1, y + 1, kCell - 2, kRow - 2, tested && largest > 0.0 ? 0.06 + 0.74 * percent / largest : 0.0,
      tested ? "none" : "3 3");
  const std::string words = tested ? figure(percent) : cell.unseen > 0 ? "·" : "";
  out += fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\" text-anchor=\"middle\">{}</text></g>\n", x + kCell / 2,
                     y + kRow / 2 + 4, words);
  return out;
}

std::string axis_svg(const ValidityMap& map) {
  std::string out;
  const double bottom = kTop + kRow * static_cast<double>(map.rows());
  for (std::size_t i = 0; i <= map.columns(); i += 2) {
    out += fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\" text-anchor=\"middle\">{}</text>\n",
                       kLeft + kCell * static_cast<double>(i), bottom + 15, figure(map.x.edges[i]));
  }
  for (std::size_t i = 0; i <= map.rows(); i += 2) {
    out += fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\" text-anchor=\"end\">{}</text>\n", kLeft - 6,
                       bottom - kRow * static_cast<double>(i) + 4, figure(map.y.edges[i]));
  }
  out += fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\" text-anchor=\"middle\">{} in {}</text>\n",
                     kLeft + kCell * static_cast<double>(map.columns()) / 2, bottom + 33, escaped(map.x.name),
                     escaped(map.x.unit));
  out += fmt::format(
      "<text transform=\"translate(14 {:.0f}) rotate(-90)\" text-anchor=\"middle\">{} in {}</text>\n",
      kTop + kRow * static_cast<double>(map.rows()) / 2, escaped(map.y.name), escaped(map.y.unit));
  return out;
}

}  // namespace

std::string validity_picture(const ValidityMap& map) {
  if (map.cells.empty()) return "";
  double largest = 0.0;
  for (const ValidityCell& cell : map.cells) {
    if (std::isfinite(percent_of(map, cell))) largest = std::max(largest, percent_of(map, cell));
  }
  const double width = kLeft + kCell * static_cast<double>(map.columns()) + 20;
  const double height = kTop + kRow * static_cast<double>(map.rows()) + kBelow;
  std::string out = fmt::format(
      "<svg viewBox=\"0 0 {0:.0f} {1:.0f}\" style=\"width:100%;max-width:{0:.0f}px;font:12px "
      "sans-serif;fill:var(--c-text)\" "
      "role=\"img\" aria-label=\"{2}\">\n",
      width, height, escaped("map of validity of " + map.signal + ": " + validity_sentence(map)));
  out += fmt::format(
      "<rect x=\"{:.0f}\" y=\"{:.0f}\" width=\"{:.0f}\" height=\"{:.0f}\" style=\"fill:var(--c-panel)\"/>\n",
      kLeft, kTop, kCell * static_cast<double>(map.columns()), kRow * static_cast<double>(map.rows()));
  for (std::size_t row = 0; row < map.rows(); ++row) {
    for (std::size_t column = 0; column < map.columns(); ++column) out += cell_svg(map, column, row, largest);
  }
  return out + axis_svg(map) + "</svg>\n";
}

std::string validity_sentence(const ValidityMap& map) {
  std::size_t with_data = 0, tested = 0, worst = 0;
  double largest = -1.0;
  for (std::size_t i = 0; i < map.cells.size(); ++i) {
    const ValidityCell& cell = map.cells[i];
    with_data += cell.fitted + cell.unseen > 0;
    tested += std::isfinite(cell.rmse);
    if (std::isfinite(cell.rmse) && cell.rmse > largest) {
      largest = cell.rmse;
      worst = i;
    }
  }
  const auto share = [&](std::size_t n) {
    return 100.0 * static_cast<double>(n) / static_cast<double>(map.cells.size());
  };
  std::string out =
      fmt::format("{:.0f} % of the cells have data, {:.0f} % were tested on runs that were not fitted to",
                  share(with_data), share(tested));
  if (tested > 0) {
    const std::size_t column = worst % map.columns(), row = worst / map.columns();
    out += fmt::format("; the error is largest at {} {} to {} {}, {} {} to {} {}: {} {}", map.x.name,
                       figure(map.x.edges[column]), figure(map.x.edges[column + 1]), map.x.unit, map.y.name,
                       figure(map.y.edges[row]), figure(map.y.edges[row + 1]), map.y.unit, figure(largest),
                       map.unit);
  }
  return out + ".";
}

}  // namespace omnihil
