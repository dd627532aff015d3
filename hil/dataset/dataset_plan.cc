#include "hil/dataset/dataset_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "hil/text/toml_keys.h"
#include "identify/record/rig.h"

namespace omnihil {
namespace {

constexpr std::string_view kFormat = "omnihil-dataset/1";
constexpr double kLargest = 1e15;

TextPlace place_of(const toml::node& node) {
  return {std::max(1, static_cast<int>(node.source().begin.line)),
          std::max(1, static_cast<int>(node.source().begin.column))};
}

// "runs/steps.csv" is inside; "../steps.csv", "/tmp/steps.csv" are not.
bool stays_inside(const std::string& file) {
  const std::filesystem::path path = std::filesystem::path(file).lexically_normal();
  return !path.is_absolute() && !path.empty() && *path.begin() != "..";
}

class PlanReader {
 public:
  PlanReader(const ModelDocument& document, std::vector<ModelProblem>& problems)
      : document_(document), keys_(document, problems) {}

  DatasetPlan read() {
    static constexpr std::string_view kTop[] = {"format", "title", "rig",    "model",    "firmware",
                                                "board",  "radio", "boot_s", "channels", "runs"};
    const toml::table& top = document_.table;
    keys_.only(top, "", kTop);
    read_head(top);
    const toml::node* channels = top.get("channels");
    if (channels == nullptr) {
      keys_.missing(top, "", "channels", "[channels] and one line per signal below it");
    } else if (!channels->is_table()) {
      keys_.wrong(*channels, "channels", fmt::format("is {}", kind_of(*channels)), "write [channels]");
    } else {
      plan_.channels_at = place_of(*channels);
      for (const auto& [key, node] : *channels->as_table()) read_channel(key, node);
      if (channels->as_table()->get("time") == nullptr)
        keys_.missing(*channels, "channels", "time", "time = { column = \"…\" }");
    }
    std::stable_sort(plan_.dataset.channels.begin(), plan_.dataset.channels.end(),
                     [](const Channel& a, const Channel& b) { return a.line < b.line; });
    read_runs(top);
    return std::move(plan_);
  }

 private:
  void read_head(const toml::table& top) {
    static constexpr std::string_view kFormats[] = {kFormat};
    keys_.word(top, "", "format", kFormats, 0);
    if (top.get("format") == nullptr) keys_.missing(top, "", "format", "format = \"omnihil-dataset/1\"");
    plan_.dataset.title = keys_.text(top, "", "title").value_or("");
    if (top.get("rig") == nullptr) keys_.missing(top, "", "rig", "rig = " + rig_choice());
    std::vector<std::string_view> rigs;
    for (const Rig* rig : all_rigs()) rigs.push_back(rig->name);
    if (const auto rig = keys_.word(top, "", "rig", rigs, std::nullopt)) {
      plan_.dataset.rig = all_rigs()[*rig];
      plan_.rig_known = true;
    }
    plan_.model = keys_.text(top, "", "model").value_or("");
    if (const toml::node* model = top.get("model")) {
      plan_.model_at = place_of(*model);
    } else {
      keys_.missing(top, "", "model", "model = \"model.toml\", the nominal model");
    }
    read_firmware(top);
  }

  void read_firmware(const toml::table& top) {
    const auto read = [&](const char* key, std::string& text, TextPlace& at) {
      text = keys_.text(top, "", key).value_or("");
      if (const toml::node* node = top.get(key)) at = place_of(*node);
    };
    read("firmware", plan_.firmware, plan_.firmware_at);
    read("board", plan_.board, plan_.board_at);
    read("radio", plan_.radio, plan_.radio_at);
    constexpr double kLongest_s = 60.0;  // a minute of emulation per simulation; a choice
    plan_.boot_s = keys_.number(top, "", "boot_s", 0.0, kLongest_s, false,
                                "seconds that an image runs before a record begins, up to 60");
  }

  void read_channel(const toml::key& key, const toml::node& node) {
    const std::string name(key.str());
    const std::string path = "channels." + name;
    const SignalRow* row = find_signal(*plan_.dataset.rig, name);
    if (row == nullptr && plan_.rig_known) {
      const auto names = signal_names(*plan_.dataset.rig);
      keys_.wrong_key(key, path,
                      fmt::format("there is no such signal on rig \"{}\"", plan_.dataset.rig->name),
                      spelling_hint(name, names));
    }
    if (!node.is_table()) {
      keys_.wrong(node, path, fmt::format("is {}", kind_of(node)),
                  "write { column = \"…\" }, with sigma, scale, offset as needed");
      return;
    }
    const toml::table& table = *node.as_table();
    static constexpr std::string_view kKeys[] = {"column",         "sigma", "scale", "offset",       "unit",
                                                 "counts_per_rev", "shaft", "role",  "clock_sigma_s"};
    keys_.only(table, path, kKeys);
    Channel channel;
    channel.signal = name;
    channel.line = place_of(node).line;
    if (table.get("column") == nullptr) {
      keys_.missing(node, path, "column", "the name of a column in the CSV files");
    }
    const auto column = keys_.text(table, path, "column");
    channel.sigma = keys_
                        .number(table, path, "sigma", 0.0, kLargest, true,
                                "allowed: more than 0, the 1-sigma noise; leave it out where it is not known")
                        .value_or(0.0);
    channel.scale = keys_
                        .number(table, path, "scale", -kLargest, kLargest, false,
                                "a finite number other than 0 is needed")
                        .value_or(1.0);
    if (channel.scale == 0.0) {
      keys_.wrong(*table.get("scale"), path + ".scale", "makes every value the same",
                  "a finite number other than 0 is needed");
    }
    channel.offset =
        keys_.number(table, path, "offset", -kLargest, kLargest, false, "a finite number is needed")
            .value_or(0.0);
    if (row != nullptr) read_signal_keys(*row, node, path, channel);
    if (row != nullptr && column) {
      channel.column = *column;
      plan_.dataset.channels.push_back(std::move(channel));
    }
  }

  // What depends on the signal: resolution of counters, unit, role.
  void read_signal_keys(const SignalRow& row, const toml::node& node, const std::string& path,
                        Channel& channel) {
    const toml::table& table = *node.as_table();
    const bool counts = row.role == SignalRole::kCounts;
    if (counts) {
      if (table.get("counts_per_rev") == nullptr)
        keys_.missing(node, path, "counts_per_rev",
                      "counts per turn of the encoder's shaft, after quadrature");
      channel.counts_per_rev = keys_
                                   .number(table, path, "counts_per_rev", 0.0, 1e9, true,
                                           "allowed: more than 0 up to 1e9, counts after quadrature")
                                   .value_or(1.0);
      static constexpr std::string_view kShafts[] = {"rotor", "output"};
      const std::size_t shafts = plan_.dataset.rig->whole_robot ? 1 : 2;
      channel.on_output =
          keys_.word(table, path, "shaft", std::span(kShafts).first(shafts), 0).value_or(0) == 1;
    } else {
      for (const char* only_counts : {"counts_per_rev", "shaft"}) {
        if (const toml::node* extra = table.get(only_counts))
          keys_.wrong(*extra, key_path(path, only_counts), "does not apply to this signal",
                      "only to encoder counts");
      }
    }
    if (const toml::node* clock = table.get("clock_sigma_s")) read_clock(*clock, table, path, channel);
    channel.unit = keys_.text(table, path, "unit").value_or("");  // held against the signal's own later
    static constexpr std::string_view kRoles[] = {"measured", "imposed"};
    channel.imposed = keys_.word(table, path, "role", kRoles, 0).value_or(0) == 1;
    if (row.imposed == Imposed::kAlways) channel.imposed = true;
    if (channel.imposed && row.imposed == Imposed::kNever) {
      keys_.wrong(*table.get("role"), path + ".role", "a bench cannot impose this signal",
                  "allowed: velocity, position or motor_current of rig \"axis\"");
    }
  }

  // Of a camera's: one clock, whatever it sees.
  void read_clock(const toml::node& node, const toml::table& table, const std::string& path,
                  Channel& channel) {
    constexpr double kLongest_s = 1.0;  // a second off is no lag but another drive; a choice
    channel.clock_sigma_s =
        keys_
            .number(table, path, "clock_sigma_s", 0.0, kLongest_s, true,
                    "allowed: more than 0 up to 1 s, 1-sigma of its clock's shift in a run")
            .value_or(0.0);
    if (!channel.signal.starts_with("vision_"))
      keys_.wrong(node, path + ".clock_sigma_s", "does not apply to this signal",
                  "only to vision_x, vision_y, vision_theta");
    for (const Channel& other : plan_.dataset.channels) {
      if (other.clock_sigma_s > 0.0 && other.clock_sigma_s != channel.clock_sigma_s)
        keys_.wrong(node, path + ".clock_sigma_s",
                    fmt::format("{} has another: {} s", other.signal, other.clock_sigma_s),
                    "one clock for all that the camera sees");
    }
  }

  void read_runs(const toml::table& top) {
    const toml::node* runs = top.get("runs");
    if (runs == nullptr) return keys_.missing(top, "", "runs", "[[runs]] with file and use");
    if (!runs->is_array_of_tables() || runs->as_array()->empty()) {
      return keys_.wrong(*runs, "runs", fmt::format("is {}", kind_of(*runs)),
                         "write [[runs]] and below it file = \"…\" and use = \"fit\"");
    }
    int number = 0;
    for (const toml::node& node : *runs->as_array()) {
      read_run(*node.as_table(), fmt::format("runs[{}]", ++number));
    }
    const auto is_fit = [](const RunPlan& r) { return r.run.split == Split::kTraining; };
    if (std::none_of(plan_.runs.begin(), plan_.runs.end(), is_fit) &&
        plan_.runs.size() == runs->as_array()->size()) {
      keys_.wrong(*runs, "runs", "no run has use \"fit\"", "at least one run to estimate on is needed");
    }
  }

  void read_run(const toml::table& table, const std::string& path) {
    static constexpr std::string_view kKeys[] = {"file", "use", "excitation", "kind", "known"};
    static constexpr std::string_view kSplitWords[] = {"fit", "holdout", "extrapolation"};
    static constexpr std::string_view kKinds[] = {"series", "steady"};
    keys_.only(table, path, kKeys);
    RunPlan plan;
    plan.at = place_of(table);
    if (table.get("file") == nullptr)
      keys_.missing(table, path, "file", "a CSV file in the dataset's folder");
    if (table.get("use") == nullptr)
      keys_.missing(table, path, "use", "\"fit\", \"holdout\" or \"extrapolation\"");
    const auto file = keys_.text(table, path, "file");
    const auto use = keys_.word(table, path, "use", kSplitWords, std::nullopt);
    plan.run.excitation = keys_.text(table, path, "excitation").value_or("");
    plan.run.steady = keys_.word(table, path, "kind", kKinds, 0).value_or(0) == 1;
    if (const toml::node* known = table.get("known")) read_known(*known, path + ".known", "", plan);
    if (!file || !use) return;
    plan.run.file = *file;
    plan.run.split = static_cast<Split>(*use);
    if (!stays_inside(*file)) {
      keys_.wrong(*table.get("file"), path + ".file", "lies outside the dataset's folder",
                  "a path inside the folder is needed, without .. and not absolute");
      return;
    }
    const auto same = [&](const RunPlan& other) { return other.run.file == plan.run.file; };
    if (std::any_of(plan_.runs.begin(), plan_.runs.end(), same)) {
      keys_.wrong(*table.get("file"), path + ".file", "is listed twice",
                  "a run that is estimated on cannot hold out itself; each file stands once");
      return;
    }
    plan_.runs.push_back(std::move(plan));
  }

  // { "load.inertia_kg_m2" = 1 } and { load.inertia_kg_m2 = 1 } alike.
  void read_known(const toml::node& node, const std::string& path, const std::string& inside, RunPlan& plan) {
    if (!node.is_table()) {
      return keys_.wrong(node, path, fmt::format("is {}", kind_of(node)),
                         "write { \"load.inertia_kg_m2\" = 6.1e-5 }");
    }
    for (const auto& [key, value] : *node.as_table()) {
      const std::string name = key_path(inside, key.str());
      if (value.is_table()) {
        read_known(value, path, name, plan);
      } else if (!value.is_number()) {
        keys_.wrong(value, path + "." + name, fmt::format("is {}", kind_of(value)), "a number is needed");
      } else {
        plan.known.push_back({name, *value.value<double>(), document_.written(value), place_of(value)});
      }
    }
  }

  const ModelDocument& document_;
  TomlKeys keys_;
  DatasetPlan plan_;
};

}  // namespace

DatasetPlan read_dataset_plan(std::string_view text, const std::string& shown_name,
                              std::vector<ModelProblem>& problems) {
  const auto document = parse_document(text, shown_name, problems);
  if (!document) return {};
  return PlanReader(*document, problems).read();
}

}  // namespace omnihil
