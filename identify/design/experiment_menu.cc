#include "identify/design/experiment_menu.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "sim/bench/excitation.h"
#include "sim/law/random.h"

namespace omnihil {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

// -1 … 1 at a time within a run of a duration.
using Wave = std::function<double(double time_s, double duration_s)>;
struct Shape {
  const char* name;
  const char* words;
  Wave wave;
};

Wave excitation(Excitation kind, std::uint64_t seed) {
  return [=](double t, double duration_s) {
    const double scale = kind == Excitation::kCreep ? 10.0 : 1.0;  // creep has its own tenth
    return scale * excitation_at(kind, t, {.duration_s = duration_s, .seed = seed});
  };
}

double triangle(double turns) {
  const double x = turns - std::floor(turns);
  return x < 0.25 ? 4.0 * x : (x < 0.75 ? 2.0 - 4.0 * x : 4.0 * x - 4.0);
}

double square(double turns) { return turns - std::floor(turns) < 0.5 ? 1.0 : -1.0; }

// Twelve sines from 0.3 to 60 Hz, each harmonic of a 10 s period, with phases that keep the sum flat.
double multisine(double t, double) {
  // Evenly over the decades: Fibonacci's numbers, and the end of the band. A choice.
  constexpr std::array<int, 12> kHarmonics = {3, 5, 8, 13, 21, 34, 55, 89, 144, 233, 377, 600};
  double sum = 0.0;
  for (std::size_t k = 0; k < kHarmonics.size(); ++k) {
    const double n = static_cast<double>(k);
    // phi_k = -pi k (k - 1) / N
    sum += std::sin(kTurn * kHarmonics[k] * t / 10.0 - std::numbers::pi * n * (n - 1.0) / kHarmonics.size());
  }
  return std::clamp(sum / 5.0, -1.0, 1.0);
}

// Eleven levels down from 1 to -1 and up again.
double staircase(double t, double duration_s) {
  const int level = static_cast<int>(22.0 * t / duration_s);
  return level < 11 ? 1.0 - 0.2 * level : -1.0 + 0.2 * (level - 11);
}

// The first and the last fifth are the same probe; between them a level is held.
double hold(double t, double duration_s) {
  const double share = t / duration_s;
  if (share >= 0.2 && share < 0.8) return 1.0;
  const double probe_s = share < 0.2 ? t : t - 0.8 * duration_s;
  return 0.6 * excitation_at(Excitation::kSteps, probe_s, {.duration_s = duration_s, .seed = 0});
}

// Full for 0.15 s, rest for 0.35 s, signs in turn.
double pulses(double t, double) {
  const double x = t / 0.5 - std::floor(t / 0.5);
  return x < 0.3 ? square(t / 1.0) : 0.0;
}

// Up for 0.6 s, against the motion for 0.2 s, rest; signs in turn.
double brake(double t, double) {
  const double x = t - std::floor(t);
  const double sign = square(t / 2.0);
  return x < 0.6 ? sign : (x < 0.8 ? -sign : 0.0);
}

std::vector<Shape> shapes(std::uint64_t seed) {
  return {
      {"steps", "steps between levels every 0.4 s", excitation(Excitation::kSteps, seed)},
      {"creep", "turns very slowly, up and down over 16 s", excitation(Excitation::kCreep, seed)},
      {"ramp", "slow ramps through zero to full level in both directions",
       excitation(Excitation::kRamp, seed)},
      {"chirp", "a sine from 0.2 to 40 Hz", excitation(Excitation::kChirp, seed)},
      {"prbs", "random signs every 20 ms", excitation(Excitation::kPrbs, seed)},
      {"multisine", "twelve sines from 0.3 to 60 Hz at once", multisine},
      {"staircase", "eleven levels held, down through zero and up again", staircase},
      {"reversals_slow", "turns round once a second", [](double t, double) { return square(t / 2.0); }},
      {"reversals_fast", "turns round five times a second", [](double t, double) { return square(t / 0.4); }},
      {"triangle_fast", "ramps through zero twice a second", [](double t, double) { return triangle(t); }},
      {"pulses", "full pulses of 0.15 s with rests between", pulses},
      {"brake", "drives 0.6 s, brakes 0.2 s against the motion, rests, both ways", brake},
      {"hold", "holds a level for most of the run, with the same steps before and after", hold},
  };
}

// Duties that roll a robot along (x, y, turn), the largest at most 1 (geometry.h); of no wheels: the twist itself.
std::vector<double> duties(std::span<const double> angle, double x, double y, double turn) {
  if (angle.empty()) return {x, y, turn};
  std::vector<double> d;
  for (const double a : angle) d.push_back(-std::sin(a) * x + std::cos(a) * y + turn);
  return d;
}

using Twist = std::function<std::array<double, 3>(double time_s)>;

// No angles: the twist itself, of the body.
MenuRun robot_run(std::string name, std::string words, const std::vector<double>& time_s,
                  std::span<const double> angle, const Twist& twist) {
  const std::size_t drives = angle.empty() ? 3 : angle.size();
  MenuRun run{std::move(name), std::move(words), std::vector<std::vector<double>>(drives)};
  double largest = 1e-12;
  for (const double t : time_s) {
    const auto [x, y, w] = twist(t - time_s.front());
    const std::vector<double> d = duties(angle, x, y, w);
    for (std::size_t i = 0; i < drives; ++i) {
      run.drive[i].push_back(d[i]);
      largest = std::max(largest, std::abs(d[i]));
    }
  }
  for (auto& wheel : run.drive) {
    for (double& v : wheel) v /= largest;
  }
  return run;
}

}  // namespace

std::vector<MenuRun> axis_menu(const std::vector<double>& time_s, std::uint64_t seed) {
  std::vector<MenuRun> menu;
  const double duration_s = time_s.back() - time_s.front();
  for (const Shape& shape : shapes(seed)) {
    MenuRun run{shape.name, shape.words, {{}}};
    for (const double t : time_s) run.drive[0].push_back(shape.wave(t - time_s.front(), duration_s));
    menu.push_back(std::move(run));
  }
  return menu;
}

namespace {

// Along x, y and the turn; of the wheels at these angles, or of the body.
std::vector<MenuRun> twist_menu(const std::vector<double>& time_s, std::span<const double> angle,
                                std::uint64_t seed) {
  std::vector<MenuRun> menu;
  const double duration_s = time_s.back() - time_s.front();
  const auto level = [=](double t, std::uint64_t which) {
    return excitation_at(Excitation::kSteps, t,
                         {.duration_s = duration_s, .seed = mix_bits(3 * seed + which)});
  };
  menu.push_back(robot_run("steps", "steps along x, y and the turn at once", time_s, angle, [=](double t) {
    return std::array<double, 3>{0.6 * level(t, 0), 0.6 * level(t, 1), 0.4 * level(t, 2)};
  }));
  // Out for 0.5 s, braked for 0.2 s, back: in twelve directions one after another.
  menu.push_back(robot_run(
      "direction_scan", "out and back in twelve directions, one after another", time_s, angle, [=](double t) {
        const double direction = kTurn / 12.0 * 5.0 * std::floor(t / 1.6);
        const double x = t / 1.6 - std::floor(t / 1.6);
        const double size = x < 0.35 ? 1.0 : (x < 0.5 ? 0.0 : (x < 0.85 ? -1.0 : 0.0));
        return std::array<double, 3>{size * std::cos(direction), size * std::sin(direction), 0.0};
      }));
  struct Way {
    const char* name;
    const char* words;
    std::array<double, 3> twist;
  };
  const Way ways[] = {{"ahead", "straight ahead and back", {1, 0, 0}},
                      {"sideways", "sideways", {0, 1, 0}},
                      {"turn", "turning on the spot", {0, 0, 1}}};
  const std::vector<Shape> all = shapes(seed);
  const auto wanted = [](std::string_view name) {
    return name == "creep" || name == "ramp" || name == "chirp" || name == "reversals_slow" ||
           name == "pulses" || name == "brake" || name == "hold";
  };
  for (const Shape& shape : all) {
    if (!wanted(shape.name)) continue;
    for (const Way& way : ways) {
      menu.push_back(
          robot_run(std::string(shape.name) + "_" + way.name, std::string(way.words) + ": " + shape.words,
                    time_s, angle, [&](double t) {
                      const double v = shape.wave(t, duration_s);
                      return std::array<double, 3>{v * way.twist[0], v * way.twist[1], v * way.twist[2]};
                    }));
    }
  }
  return menu;
}

}  // namespace

std::vector<MenuRun> body_menu(const std::vector<double>& time_s, std::uint64_t seed) {
  return twist_menu(time_s, {}, seed);
}

std::vector<MenuRun> robot_menu(const std::vector<double>& time_s, std::span<const double> angle,
                                std::uint64_t seed) {
  std::vector<MenuRun> menu = twist_menu(time_s, angle, seed);
  // One wheel against all: the difference is due to what they share, the supply.
  const int wheels = static_cast<int>(angle.size());
  MenuRun single{"one_and_all",
                 fmt::format("each wheel alone, then all {} together, again and again",
                             wheels == 4 ? "four" : std::to_string(wheels)),
                 std::vector<std::vector<double>>(angle.size())};
  for (const double now_s : time_s) {
    const double t = now_s - time_s.front();
    const double round = 2.0 * wheels + 2.0;  // half seconds
    const int turn = static_cast<int>(t / 0.5) % (2 * wheels + 2);
    const double sign = static_cast<int>(t / (0.5 * round)) % 2 == 0 ? 1.0 : -1.0;
    for (int i = 0; i < wheels; ++i) {
      const bool on = turn % 2 == 0 && (turn == 2 * wheels || turn / 2 == i);
      single.drive[static_cast<std::size_t>(i)].push_back(on ? sign : 0.0);
    }
  }
  menu.push_back(std::move(single));
  return menu;
}

}  // namespace omnihil
