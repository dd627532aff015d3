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

// "MEAN", "LEAST,MEAN", "LEAST,MEAN,LAW", "LEAST,MEAN,lognormal,SIGMA", in ms.
bool latency_of(const std::string& text, AirOptions& air) {
  std::vector<std::string> words;
  std::istringstream in(text);
  for (std::string word; std::getline(in, word, ',');) words.push_back(word);
  double least_ms = 0.0, mean_ms = 0.0;
  if (words.empty() || words.size() > 4 || text.back() == ',' || !numbers_of(words[0], {&least_ms}))
    return false;
  if (words.size() == 1) mean_ms = least_ms;
  if (words.size() > 1 && !numbers_of(words[1], {&mean_ms})) return false;
  const std::string law = words.size() > 2 ? words[2] : "exponential";
  if (law == "uniform") air.latency_law = LatencyLaw::kUniform;
  if (law == "lognormal") air.latency_law = LatencyLaw::kLognormal;
  const bool lognormal = air.latency_law == LatencyLaw::kLognormal;
  if (air.latency_law == LatencyLaw::kExponential && law != "exponential") return false;
  if (lognormal != (words.size() == 4)) return false;
  if (lognormal && !numbers_of(words[3], {&air.latency_sigma})) return false;
  air.latency_least_s = least_ms / 1e3;
  air.latency_mean_s = mean_ms / 1e3;
  return true;
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
  air.twice_share = words.duplicates_percent / 100.0;
  air.bit_error_rate = words.bit_errors;
  air.in_order = words.in_order;
  if (!words.latency.empty() && !latency_of(words.latency, air))
    problems.push_back("--air-latency: found \"" + words.latency +
                       "\", allowed: ms, as MEAN, LEAST,MEAN, LEAST,MEAN,uniform or "
                       "LEAST,MEAN,lognormal,SIGMA such as 1,3,lognormal,0.8");
  if (air.in_order && words.latency.empty() && words.reorder.empty())
    problems.push_back("--air-in-order: needs --air-latency or --air-reorder");
  double percent = 0.0;
  if (!words.reorder.empty()) {
    if (numbers_of(words.reorder, {&percent, &air.held_s})) {
      air.held_share = percent / 100.0;
      air.held_s /= 1e3;
    } else {
      problems.push_back("--air-reorder: found \"" + words.reorder + "\", allowed: PERCENT,MS such as 1,15");
    }
  }
  if (words.burst.empty()) return;
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
  verb.add_option("--air-latency", words.latency,
                  "LEAST,MEAN[,LAW] in ms, on top of the dongle's own times: exponential above the least, "
                  "uniform, or lognormal,SIGMA; one number: always that");
  verb.add_option("--air-duplicates", words.duplicates_percent, "per cent of packets that arrive twice")
      .range(0.0, 100.0)
      .capture_default_str();
  verb.add_option("--air-reorder", words.reorder,
                  "PERCENT,MS: so many packets are held back so long, and others overtake them");
  verb.add_flag("--air-in-order", words.in_order, "no packet overtakes another of the same robot and way");
  verb.add_option("--air-bit-errors", words.bit_errors,
                  "chance of each bit of a packet to be wrong; the format's own checks refuse what they see")
      .range(0.0, 0.5)
      .capture_default_str();
}

}  // namespace omnihil
