#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "hil/scenario/chip_fault_reader.h"
#include "hil/scenario/scenario.h"
#include "hil/scenario/scenario_rows.h"
#include "hil/scenario/scenario_signals.h"
#include "hil/text/toml_keys.h"
#include "sim/field/field_size.h"

namespace omnihil {
namespace {

constexpr double kLongest_s = 600.0;
constexpr double kFastest_m_s = 20.0, kFastest_rad_s = 1000.0, kHottest_K = 300.0, kForce = 1000.0;
constexpr double kFarthest_m = 20.0, kFastestBall_m_s = 30.0, kTurn_rad = 10.0;
constexpr int kMostOpponents = 11;

std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> words;
  while (!text.empty()) {
    const std::size_t space = std::min(text.find(' '), text.size());
    words.push_back(text.substr(0, space));
    text.remove_prefix(std::min(space + 1, text.size()));
  }
  return words;
}

template <class Rows>
std::vector<std::string_view> words_of_rows(const Rows& rows) {
  std::vector<std::string_view> words;
  for (const auto& row : rows) words.push_back(row.word);
  return words;
}

class Reader {
 public:
  Reader(const ModelDocument& document, std::vector<ModelProblem>& problems)
      : document_(document), problems_(problems), keys_(document, problems) {}

  Scenario read() {
    head();
    each("step", [this](const toml::table& t, const std::string& path) { step(t, path); });
    each("check", [this](const toml::table& t, const std::string& path) { check(t, path); });
    if (out_.steps.empty()) keys_.missing(document_.table, "", "step", "at least one [[step]]");
    if (out_.checks.empty()) keys_.missing(document_.table, "", "check", "at least one [[check]]");
    std::ranges::stable_sort(out_.steps, {}, &ScenarioStep::at_s);
    const bool good = problems_.empty();  // else what a check refers to may be missing
    for (std::size_t i = 0; good && i < out_.checks.size(); ++i) settle(out_.checks[i], i);
    return std::move(out_);
  }

 private:
  void head() {
    const toml::table& t = document_.table;
    keys_.only(
        t, "",
        words_of("format title what level robot stand commands duration_s command_every_ms step check field "
                 "opponents goes_on_after_failure"));
    static constexpr std::string_view kFormat[] = {"omnihil-scenario/1"};
    need(t, "", "format", "\"omnihil-scenario/1\"");
    keys_.word(t, "", "format", kFormat, 0);
    out_.file = document_.file;
    out_.title = needed_text(t, "", "title", "a text");
    out_.what = keys_.text(t, "", "what").value_or("");
    out_.robot = keys_.text(t, "", "robot").value_or(out_.robot);
    static constexpr std::string_view kLevels[] = {"wheel", "robot", "field"};
    out_.level = kLevels[keys_.word(t, "", "level", kLevels, 0).value_or(0)];
    static constexpr std::string_view kPaths[] = {"any", "radio", "hal"};
    out_.path = static_cast<CommandPath>(keys_.word(t, "", "commands", kPaths, 0).value_or(0));
    out_.stand = flag(t, "", "stand");
    out_.goes_on = flag(t, "", "goes_on_after_failure");
    std::vector<std::string_view> fields;
    for (const FieldSize& size : field_sizes()) fields.push_back(size.name);
    if (t.get("field") != nullptr) {
      if (const auto n = keys_.word(t, "", "field", fields, std::nullopt)) out_.field = fields[*n];
    }
    out_.opponents = count(t, "", "opponents", kMostOpponents);
    need(t, "", "duration_s", "above 0, up to 600 s");
    out_.duration_s = time(t, "", "duration_s", true, kLongest_s).value_or(0.0);
    out_.command_every_s =
        1e-3 *
        keys_.number(t, "", "command_every_ms", 1.0, 1000.0, false, "allowed: 1 to 1000 ms").value_or(10.0);
    whole_ms(t, "", "command_every_ms", out_.command_every_s);
  }

  template <class Work>
  void each(std::string_view key, Work&& work) {
    const toml::node* node = document_.table.get(key);
    if (node == nullptr) return;
    if (!node->is_array_of_tables()) {
      keys_.wrong(*node, std::string(key), fmt::format("is {}", kind_of(*node)),
                  fmt::format("needed: tables that start with [[{}]]", key));
      return;
    }
    std::size_t n = 0;
    for (const toml::node& entry : *node->as_array())
      work(*entry.as_table(), fmt::format("{}[{}]", key, ++n));
  }

  void need(const toml::table& t, const std::string& path, std::string_view key, const std::string& allowed) {
    if (t.get(key) == nullptr) keys_.missing(t, path, key, allowed);
  }

  std::string needed_text(const toml::table& t, const std::string& path, std::string_view key,
                          const std::string& what) {
    need(t, path, key, what);
    return keys_.text(t, path, key).value_or("");
  }

  bool flag(const toml::table& t, const std::string& path, std::string_view key) {
    const toml::node* node = t.get(key);
    if (node == nullptr) return false;
    if (const auto value = node->value_exact<bool>()) return *value;
    keys_.wrong(*node, key_path(path, key), fmt::format("is {}", kind_of(*node)), "allowed: true, false");
    return false;
  }

  // A whole number from 0 to `most`; 0 where none is given.
  int count(const toml::table& t, const std::string& path, std::string_view key, int most) {
    const toml::node* node = t.get(key);
    if (node == nullptr) return 0;
    const auto value = node->value_exact<std::int64_t>();
    if (value && *value >= 0 && *value <= most) return static_cast<int>(*value);
    keys_.wrong(*node, key_path(path, key), "is not allowed here",
                fmt::format("allowed: a whole number, 0 to {}", most));
    return 0;
  }

  void whole_ms(const toml::table& t, const std::string& path, std::string_view key, double time_s) {
    if (t.get(key) == nullptr || std::abs(time_s * 1e3 - std::round(time_s * 1e3)) < 1e-6) return;
    keys_.wrong(*t.get(key), key_path(path, key), "is no whole number of milliseconds",
                "allowed: a multiple of 1 ms");
  }

  std::optional<double> time(const toml::table& t, const std::string& path, std::string_view key,
                             bool above_zero, double last_s) {
    const auto value =
        keys_.number(t, path, key, 0.0, last_s, above_zero,
                     fmt::format("allowed: {} 0 to {:g} s", above_zero ? "above" : "", last_s));
    if (value) whole_ms(t, path, key, *value);
    return value;
  }

  double within(const toml::table& t, const std::string& path, std::string_view key, double most,
                double otherwise = 0.0) {
    return keys_.number(t, path, key, -most, most, false, fmt::format("allowed: {:g} to {:g}", -most, most))
        .value_or(otherwise);
  }

  // wheels = [0, 2]; all where none are named.
  WheelSet wheels(const toml::table& t, const std::string& path, bool needed) {
    WheelSet set{};
    const toml::node* node = t.get("wheels");
    if (node == nullptr) {
      if (needed) keys_.missing(t, path, "wheels", "wheel numbers 0 to 3, such as [0, 2]");
      set.fill(true);
      return set;
    }
    const toml::array* list = node->as_array();
    bool good = list != nullptr && !list->empty();
    for (std::size_t i = 0; good && i < list->size(); ++i) {
      const auto wheel = list->get(i)->value_exact<std::int64_t>();
      good = wheel && *wheel >= 0 && *wheel < kWheels && !set[static_cast<std::size_t>(*wheel)];
      if (good) set[static_cast<std::size_t>(*wheel)] = true;
    }
    if (!good) {
      keys_.wrong(*node, key_path(path, "wheels"), "names no wheels",
                  "allowed: numbers 0 to 3 in brackets, each once, such as [0, 2]");
    }
    return set;
  }

  // One number for all wheels, or four.
  void per_wheel(const toml::table& t, const std::string& path, std::string_view key, double most,
                 double (&out)[kWheels]) {
    const toml::node* node = t.get(key);
    const std::string allowed = fmt::format("allowed: one number or four, {:g} to {:g}", -most, most);
    const toml::array* list = node->as_array();
    bool good = list == nullptr ? node->is_number() : list->size() == kWheels;
    for (std::size_t w = 0; good && w < kWheels; ++w) {
      const toml::node& entry = list == nullptr ? *node : *list->get(w);
      const auto value = entry.value<double>();
      good = entry.is_number() && value && std::abs(*value) <= most;
      if (good) out[w] = *value;
    }
    if (!good) keys_.wrong(*node, key_path(path, key), "is not allowed here", allowed);
  }

  void step(const toml::table& t, const std::string& path) {
    const std::vector<std::string_view> words = words_of_rows(step_rows());
    need(t, path, "do", fmt::format("{}", fmt::join(words, ", ")));
    need(t, path, "at_s", "an instant in s");
    const auto kind = keys_.word(t, path, "do", words, std::nullopt);
    ScenarioStep s;
    s.line = static_cast<int>(t.source().begin.line);
    const double last_s = out_.duration_s > 0.0 ? out_.duration_s : kLongest_s;
    const bool of_chip = kind && step_rows()[*kind].kind == StepKind::kChip;  // between any two instructions
    s.at_s =
        of_chip
            ? keys_.number(t, path, "at_s", 0.0, last_s, false, fmt::format("allowed: 0 to {:g} s", last_s))
                  .value_or(0.0)
            : time(t, path, "at_s", false, last_s).value_or(0.0);
    if (!kind) return;
    const StepRow& row = step_rows()[*kind];
    s.kind = row.kind;
    if (of_chip) s.chip.kind = *chip_fault_kind(row.word);
    std::vector<std::string_view> known = words_of(row.keys);
    known.insert(known.end(), {"at_s", "do"});
    if (row.lasts) known.push_back("for_s");
    if (row.of_wheels) known.push_back("wheels");
    keys_.only(t, path, known);
    s.until_s = out_.duration_s;
    if (const auto span =
            of_chip ? keys_.number(t, path, "for_s", 0.0, kLongest_s, true, "allowed: above 0 to 600 s")
                    : time(t, path, "for_s", true, kLongest_s)) {
      s.until_s = s.at_s + *span;
      s.chip.until_ns = std::llround(s.until_s * 1e9);
    }
    if (row.of_wheels) s.wheels = wheels(t, path, true);
    step_values(t, path, s);
    out_.steps.push_back(s);
  }

  void step_values(const toml::table& t, const std::string& path, ScenarioStep& s) {
    switch (s.kind) {
      case StepKind::kCommand:
        command(t, path, s.command);
        s.of_top_speed = t.get("omega_wheel_top_ratio") != nullptr;
        break;
      case StepKind::kDisturb:
        s.force_forward_N = within(t, path, "force_forward_N", kForce);
        s.force_left_N = within(t, path, "force_left_N", kForce);
        s.moment_Nm = within(t, path, "moment_Nm", kForce);
        break;
      case StepKind::kBrownOut:
        need(t, path, "supply_ratio", "0 to 2");
        s.supply_ratio =
            keys_.number(t, path, "supply_ratio", 0.0, 2.0, false, "allowed: 0 to 2").value_or(1.0);
        break;
      case StepKind::kWindingHot:
        need(t, path, "rise_K", "-100 to 300");
        s.rise_K = keys_.number(t, path, "rise_K", -100.0, kHottest_K, false, "allowed: -100 to 300 K")
                       .value_or(0.0);
        break;
      case StepKind::kBall:
        s.z_m = keys_.number(t, path, "z_m", 0.0, kFarthest_m, false, "allowed: 0 to 20").value_or(0.0);
        s.v_x_m_s = within(t, path, "v_x_m_s", kFastestBall_m_s);
        s.v_y_m_s = within(t, path, "v_y_m_s", kFastestBall_m_s);
        s.v_z_m_s = within(t, path, "v_z_m_s", kFastestBall_m_s);
        place(t, path, s);
        break;
      case StepKind::kOpponentAt:
        s.opponent = count(t, path, "opponent", out_.opponents - 1);
        if (out_.opponents == 0)
          keys_.wrong(*t.get("do"), key_path(path, "do"), "there is no opponent",
                      "needed: opponents = 1 or more at the head");
        place(t, path, s);
        break;
      case StepKind::kRobotAt:
        place(t, path, s);
        break;
      case StepKind::kSet:
        s.variable = needed_text(t, path, "name", "a variable of the firmware");
        s.value = value_text(keys_, t, path);
        break;
      case StepKind::kType:
        s.typed = needed_text(t, path, "text", "what is typed");
        break;
      case StepKind::kChip:
        s.chip.at_ns = std::llround(s.at_s * 1e9);
        read_chip_fault(keys_, t, path, s.chip);
        break;
      default:
        break;
    }
  }

  void place(const toml::table& t, const std::string& path, ScenarioStep& s) {
    s.x_m = within(t, path, "x_m", kFarthest_m);
    s.y_m = within(t, path, "y_m", kFarthest_m);
    s.yaw_rad = within(t, path, "yaw_rad", kTurn_rad);
  }

  void handling(const toml::table& t, const std::string& path, RobotCommand& c) {
    const bool kicks = t.get("kick_m_s") != nullptr, chips = t.get("chip_m_s") != nullptr;
    if (kicks && chips)
      keys_.wrong(*t.get("chip_m_s"), key_path(path, "chip_m_s"), "stands beside kick_m_s", "allowed: one");
    const char* const key = kicks ? "kick_m_s" : "chip_m_s";
    if (kicks || chips) {
      c.kick = kicks ? OMNIHIL_KICK_STRAIGHT : OMNIHIL_KICK_CHIP;
      c.kick_when = OMNIHIL_KICK_ON_BALL;
      c.v_kick_m_s = keys_.number(t, path, key, 0.0, 15.0, true, "allowed: above 0 to 15").value_or(0.0);
    }
    c.dribbler_ratio =
        keys_.number(t, path, "dribbler_ratio", 0.0, 1.0, false, "allowed: 0 to 1").value_or(0.0);
    if (flag(t, path, "charge") || kicks || chips) c.flags |= OMNIHIL_COMMAND_CHARGE;
  }

  void command(const toml::table& t, const std::string& path, RobotCommand& c) {
    int families = 0;
    const auto has = [&t](std::string_view key) { return t.get(key) != nullptr; };
    if (has("v_forward_m_s") || has("v_left_m_s") || has("omega_body_rad_s")) {
      ++families;
      c.mode = OMNIHIL_MODE_BODY_VELOCITY;
      c.v_forward_m_s = within(t, path, "v_forward_m_s", kFastest_m_s);
      c.v_left_m_s = within(t, path, "v_left_m_s", kFastest_m_s);
      c.omega_body_rad_s = within(t, path, "omega_body_rad_s", kFastest_rad_s);
    }
    if (has("omega_wheel_rad_s")) {
      ++families;
      c.mode = OMNIHIL_MODE_WHEEL_SPEED;
      per_wheel(t, path, "omega_wheel_rad_s", kFastest_rad_s, c.omega_wheel_rad_s);
    }
    if (has("omega_wheel_top_ratio")) {
      ++families;
      c.mode = OMNIHIL_MODE_WHEEL_SPEED;
      per_wheel(t, path, "omega_wheel_top_ratio", 1.0, c.omega_wheel_rad_s);
    }
    if (has("duty_ratio")) {
      ++families;
      c.mode = OMNIHIL_MODE_WHEEL_DUTY;
      per_wheel(t, path, "duty_ratio", 1.0, c.duty_ratio);
    }
    if (flag(t, path, "coast")) {
      ++families;
      c.mode = OMNIHIL_MODE_COAST;
    }
    handling(t, path, c);
    if (families == 1) return;
    keys_.wrong(
        *t.get("do"), key_path(path, "do"),
        families == 0 ? "says not what is commanded" : "commands two things at once",
        "needed: a body velocity (v_forward_m_s, v_left_m_s, omega_body_rad_s), or omega_wheel_rad_s, "
        "or omega_wheel_top_ratio, or duty_ratio, or coast = true");
  }

  void check(const toml::table& t, const std::string& path) {
    const std::vector<std::string_view> words = words_of_rows(check_rows());
    need(t, path, "is", fmt::format("{}", fmt::join(words, ", ")));
    const auto kind = keys_.word(t, path, "is", words, std::nullopt);
    if (!kind) return;
    const CheckRow& row = check_rows()[*kind];
    ScenarioCheck c;
    c.kind = row.kind;
    c.line = static_cast<int>(t.source().begin.line);
    c.from_s = time(t, path, "from_s", false, out_.duration_s).value_or(-1.0);
    c.to_s = time(t, path, "to_s", true, out_.duration_s).value_or(-1.0);
    c.wheels = wheels(t, path, false);
    std::vector<std::string_view> known = words_of(row.keys);
    known.insert(known.end(), {"is", "from_s", "to_s"});
    if (row.of_wheels) known.push_back("wheels");
    if (row.follows_step) known.push_back("signal");
    std::string suffix(row.suffix);
    if (row.follows_step || c.kind == CheckKind::kSignal) read_signal(t, path, row, c, suffix);
    const std::string most = "at_most_" + suffix, least = "at_least_" + suffix;
    const bool console = of_console(c.kind);
    if (console) read_console(t, path, c);
    if (c.kind == CheckKind::kConsoleSays && t.get(most) == nullptr) {
      known.push_back(most);
    } else if (!suffix.empty() || c.kind == CheckKind::kSignal) {
      limits(t, path, c, most, least, known);
    }
    c.band_ratio =
        keys_.number(t, path, "band_ratio", 0.0, 1.0, true, "allowed: above 0 to 1").value_or(0.05);
    c.standstill_rad_s =
        keys_.number(t, path, "standstill_rad_s", 0.0, kFastest_rad_s, true, "allowed: above 0")
            .value_or(1.0);
    c.magnitude = flag(t, path, "magnitude");
    keys_.only(t, path, known);
    out_.checks.push_back(c);
  }

  void read_console(const toml::table& t, const std::string& path, ScenarioCheck& c) {
    c.text = needed_text(t, path, "text", "what stands in a line");
    c.port = keys_.text(t, path, "port").value_or("");
    if (t.get("board") != nullptr) c.board = count(t, path, "board", kWheels - 1);
  }

  void read_signal(const toml::table& t, const std::string& path, const CheckRow& row, ScenarioCheck& c,
                   std::string& suffix) {
    c.signal = "omega_wheel_rad_s";
    if (c.kind == CheckKind::kSignal) need(t, path, "signal", "the name of a signal");
    const auto name = keys_.text(t, path, "signal");
    if (name) {
      std::vector<std::string_view> allowed;
      for (const ScenarioSignal& s : scenario_signals()) {
        if (!row.follows_step || !s.target.empty()) allowed.push_back(s.name);
      }
      const bool variable = !row.follows_step && name->starts_with(kVariablePrefix);
      if (variable && name->size() > kVariablePrefix.size()) {
        c.signal = *name;
      } else if (std::ranges::find(allowed, *name) == allowed.end()) {
        keys_.wrong(*t.get("signal"), key_path(path, "signal"), "no such signal here",
                    spelling_hint(*name, allowed));
      } else {
        c.signal = find_scenario_signal(*name)->name;
      }
    }
    const ScenarioSignal& signal = *find_scenario_signal(c.signal);
    if (c.kind == CheckKind::kSignal) suffix = signal.suffix;
    if (!signal.of_wheels) c.wheels = {true, false, false, false};
  }

  void limits(const toml::table& t, const std::string& path, ScenarioCheck& c, const std::string& most,
              const std::string& least, std::vector<std::string_view>& known) {
    known.push_back(most);
    const bool signal = c.kind == CheckKind::kSignal;
    if (signal) known.push_back(least);
    c.at_most = keys_.number(t, path, most, -1e9, 1e9, false, "allowed: a number");
    if (signal) c.at_least = keys_.number(t, path, least, -1e9, 1e9, false, "allowed: a number");
    if (t.get(most) != nullptr || (signal && t.get(least) != nullptr)) return;
    keys_.missing(t, path, most, signal ? "this, or " + least + ", or both" : "the largest allowed value");
  }

  void wrong_check(std::size_t n, std::string what, std::string allowed) {
    const toml::node& node = *document_.table.get("check")->as_array()->get(n);
    keys_.wrong(node, fmt::format("check[{}]", n + 1), std::move(what), std::move(allowed));
  }

  const ScenarioStep* find_step(StepKind kind, double from_s) const {
    for (const ScenarioStep& s : out_.steps) {
      if (s.kind == kind && s.at_s >= from_s) return &s;
    }
    return nullptr;
  }

  // Windows that were not given follow from the steps.
  void settle(ScenarioCheck& c, std::size_t n) {
    const CheckRow& row = row_of(c.kind);
    const ScenarioStep* cause = nullptr;
    const bool follows = row.follows_step || c.kind == CheckKind::kWheelOrder;
    if (follows) cause = find_step(StepKind::kCommand, std::max(0.0, c.from_s));
    if (follows_silence(c.kind)) cause = find_step(StepKind::kRadioSilence, c.from_s);
    if (c.kind == CheckKind::kWindUp) cause = find_step(StepKind::kWheelBlocked, c.from_s);
    if (follows && cause == nullptr && c.from_s < 0.0) {
      return wrong_check(n, fmt::format("\"{}\" has no command to follow", row.word),
                         "needed: a command step");
    }
    if (cause == nullptr && !follows && needs_cause(c.kind)) {
      return wrong_check(n, fmt::format("\"{}\" has no cause", row.word),
                         c.kind == CheckKind::kWindUp ? "needed: a step wheel_blocked with for_s"
                                                      : "needed: a step radio_silence");
    }
    if (c.kind == CheckKind::kWindUp) {
      c.from_s = cause->until_s;
      for (std::size_t w = 0; w < kWheels; ++w) c.wheels[w] = c.wheels[w] && cause->wheels[w];
    } else if (follows_silence(c.kind)) {
      c.from_s = cause->at_s;
      if (c.to_s < 0.0) c.to_s = cause->until_s;
    } else if (c.from_s < 0.0) {
      c.from_s = follows ? cause->at_s : 0.0;
    }
    if (c.to_s < 0.0) c.to_s = follows ? next_step_s(c.from_s) : out_.duration_s;
    if (c.to_s <= c.from_s) {
      wrong_check(n, fmt::format("its window {:g} to {:g} s is empty", c.from_s, c.to_s),
                  "needed: from_s before to_s, within the run");
    }
  }

  static bool follows_silence(CheckKind kind) {
    return kind == CheckKind::kStopsAfterSilence || kind == CheckKind::kStopsSafely;
  }
  static bool needs_cause(CheckKind kind) { return kind == CheckKind::kWindUp || follows_silence(kind); }

  double next_step_s(double after_s) const {
    for (const ScenarioStep& s : out_.steps) {
      if (s.at_s > after_s) return s.at_s;
    }
    return out_.duration_s;
  }

  const ModelDocument& document_;
  std::vector<ModelProblem>& problems_;
  TomlKeys keys_;
  Scenario out_;
};

}  // namespace

ScenarioReading read_scenario(std::string_view text, const std::string& file) {
  ScenarioReading reading;
  const auto document = parse_document(text, file, reading.problems);
  if (!document) return reading;
  Scenario scenario = Reader(*document, reading.problems).read();
  scenario.text = text;
  if (reading.problems.empty()) reading.scenario = std::move(scenario);
  return reading;
}

}  // namespace omnihil
