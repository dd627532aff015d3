#include "tools/options/air_options.h"

#include <initializer_list>
#include <sstream>

namespace omnihil {
namespace {

// "A,B" or "A,B,C" of numbers.
bool numbers_of(const std::string& text, std::initializer_list<double*> places) {
  std::istringstream in(text);
  std::size_t n = 0;
  for (double* place : places) {
    if (n++ > 0 && in.get() != ',') return false;
    if (!(in >> *place)) return false;
  }
  return in.peek() == std::istringstream::traits_type::eof();
}

}  // namespace

void understand_air(const AirWords& words, AirOptions& air, std::vector<std::string>& problems) {
  air.share = words.loss_percent / 100.0;
  air.others_load = words.others_load;
  if (!words.transmitter.empty()) {
    air.by_distance = numbers_of(words.transmitter, {&air.x_m, &air.y_m});
    if (!air.by_distance)
      problems.push_back("--air-distance: found \"" + words.transmitter +
                         "\", allowed: X,Y in m such as -4.5,0");
  }
  if (words.burst.empty()) return;
  double percent = 0.0;
  if (numbers_of(words.burst, {&air.burst_good_packets, &air.burst_bad_packets, &percent})) {
    air.burst_share = percent / 100.0;
  } else {
    problems.push_back("--air-burst: found \"" + words.burst +
                       "\", allowed: GOOD,BAD,PERCENT such as 200,8,90");
  }
}

void add_air_options(Verb& verb, AirWords& words) {
  verb.add_option("--air-loss", words.loss_percent, "per cent of packets that the radio loses, each way")
      .range(0.0, 100.0)
      .capture_default_str();
  verb.add_option(
      "--air-distance", words.transmitter,
      "X,Y in m of the transmitter: loss by distance as in the seed paper, eqs. (2), (3) (docs/serve.md)");
  verb.add_option("--air-burst", words.burst,
                  "GOOD,BAD,PERCENT: bursts (Gilbert, Elliott) of BAD packets in the mean, GOOD between "
                  "them, losing PERCENT");
  verb.add_option("--air-others", words.others_load,
                  "load of senders that do not listen, in packet times: collisions as in pure ALOHA")
      .range(0.0, 10.0)
      .capture_default_str();
}

}  // namespace omnihil
