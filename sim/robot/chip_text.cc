// The chip kick's network as text, for model files.
#include <fmt/format.h>

#include <cmath>
#include <sstream>

#include "sim/robot/ball_handling.h"

namespace omnihil {
namespace {

// Every number of it, in the order of the text.
template <class Network, class Visit>
void each_number(Network& n, Visit visit) {
  for (auto& row : n.w1)
    for (auto& w : row) visit(w);
  for (auto& b : n.b1) visit(b);
  for (auto& row : n.w2)
    for (auto& w : row) visit(w);
  for (auto& b : n.b2) visit(b);
  for (auto* range : {&n.in_least, &n.in_most, &n.out_least, &n.out_most})
    for (auto& x : *range) visit(x);
}

}  // namespace

std::string chip_text(const ChipNetwork& network) {
  std::string text;
  each_number(network, [&](double x) { text += fmt::format("{}{:.9g}", text.empty() ? "" : " ", x); });
  return text;
}

std::optional<ChipNetwork> chip_of_text(std::string_view text) {
  std::istringstream in{std::string(text)};
  ChipNetwork network;
  bool good = true;
  each_number(network, [&](double& x) { good = good && (in >> x) && std::isfinite(x); });
  in >> std::ws;
  for (std::size_t i = 0; i < 2; ++i)
    good = good && network.in_least[i] < network.in_most[i] && network.out_least[i] < network.out_most[i];
  if (!good || !in.eof()) return std::nullopt;
  return network;
}

}  // namespace omnihil
