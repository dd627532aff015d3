#include "hil/dataset/dataset_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "hil/dataset/dataset_firmware.h"
#include "hil/dataset/dataset_runs.h"
#include "hil/firmware/open_firmware.h"
#include "hil/loop/session_checks.h"
#include "hil/radio_file/radio_file.h"
#include "hil/text/text_file.h"
#include "hil/text/toml_keys.h"
#include "identify/predict/torque_scale.h"
#include "identify/record/rig.h"
#include "sim/model/axis_model.h"
#include "sim/model/model_rows.h"
#include "sim/model/rolling_model.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;

class DatasetReader {
 public:
  DatasetReader(const std::string& path, const std::string& model, OtherFirmware firmware)
      : asked_(path), other_model_(model), other_firmware_(std::move(firmware)) {
    std::error_code code;
    toml_ =
        fs::is_directory(path, code) ? (fs::path(path) / "dataset.toml").lexically_normal().string() : path;
    folder_ = fs::path(toml_).parent_path().string();
  }

  DatasetReading read() {
    std::string error;
    const std::string text = read_text_file(toml_, error);
    if (!error.empty()) {
      problem({}, "", "", error, "a dataset is a folder with a dataset.toml");
      return std::move(out_);
    }
    plan_ = read_dataset_plan(text, toml_, out_.problems);
    if (!plan_.rig_known) return std::move(out_);
    read_nominal();
    dataset_ = plan_.dataset;
    dataset_.name = asked_;
    if (out_.nominal) {
      dataset_.linear = out_.nominal->file.linear;
      check_known();
    }
    settle_units();
    add_runs(plan_, folder_, toml_, dataset_, out_.problems);
    if (out_.problems.empty()) {
      check_signals();
      read_firmware();
      check_model();
    }
    if (!dataset_.has(Split::kValidation)) {
      dataset_.notes.push_back(
          "no run has use \"holdout\": errors on unseen data come from blocked cross-validation");
    }
    if (out_.problems.empty()) {
      if (out_.nominal) out_.nominal->torque_scale = torque_scale_of(dataset_, *out_.nominal);
      out_.dataset = std::move(dataset_);
    } else {
      out_.nominal.reset();
    }
    return std::move(out_);
  }

 private:
  void problem(TextPlace at, std::string key, std::string value, std::string what, std::string allowed) {
    out_.problems.push_back({.file = toml_,
                             .line = at.line,
                             .column = at.column,
                             .key = std::move(key),
                             .value = std::move(value),
                             .what = std::move(what),
                             .allowed = std::move(allowed)});
  }

  void read_nominal() {
    if (plan_.model.empty() && other_model_.empty()) return;  // said
    model_file_ =
        other_model_.empty() ? (fs::path(folder_) / plan_.model).lexically_normal().string() : other_model_;
    CandidateReading reading = read_candidate(model_file_);
    out_.model_text = std::move(reading.text);
    for (ModelProblem& p : reading.problems) out_.problems.push_back(std::move(p));
    if (!reading.candidate) return;
    const bool robot = reading.candidate->file.rig == "robot";
    if (robot != plan_.dataset.rig->of_robot) {
      problem(plan_.model_at, "model", fmt::format("\"{}\"", model_file_),
              fmt::format("is a model of rig \"{}\"", reading.candidate->file.rig),
              fmt::format("the dataset's rig is \"{}\"", plan_.dataset.rig->name));
      return;
    }
    out_.nominal = std::move(reading.candidate);
  }

  std::uint32_t rig_bit() const {
    if (dataset_.rig->of_robot) return kRigRobot;
    return dataset_.linear ? kRigLinearAxis : kRigAxis;
  }

  // Numbers a run knows: paths of the model's parameters or of its effects', within their bounds.
  void check_known() {
    Candidate trial = *out_.nominal;
    for (std::size_t r = 0; r < plan_.runs.size(); ++r) {
      for (const KnownNumber& known : plan_.runs[r].known) {
        const std::string key = fmt::format("runs[{}].known.{}", r + 1, known.path);
        const ParameterRow* row = model_row_at(known.path);
        if (value_at(trial, known.path)) {
          const std::string fault = set_value(trial, known.path, known.value);
          if (!fault.empty()) problem(known.at, key, known.written, "is out of range", fault);
        } else if (row == nullptr) {
          problem(known.at, key, known.written, "the model has no such parameter",
                  parameter_hint(known.path));
        } else if (!within_bounds(*row, known.value)) {
          problem(known.at, key, known.written, "is out of range", "allowed: " + allowed_range(*row));
        }
      }
    }
  }

  // Of a number of this rig that a model may have, given or not; else null.
  const ParameterRow* model_row_at(const std::string& path) const {
    const std::size_t dot = path.rfind('.');
    if (dot == std::string::npos) return nullptr;
    const ParameterRow* row = find_model_row(path.substr(0, dot), path.substr(dot + 1));
    return row != nullptr && (row->rigs & rig_bit()) != 0 && row->kind != ParameterKind::kText ? row
                                                                                               : nullptr;
  }

  std::string parameter_hint(const std::string& path) const {
    std::vector<std::string> paths;
    for (const ParameterRow& row : model_rows()) {
      const std::string known = parameter_path(row);
      if (model_row_at(known) != nullptr) paths.push_back(known);
    }
    const std::vector<std::string_view> names(paths.begin(), paths.end());
    const std::string_view near = nearest_spelling(path, names);
    return near.empty() ? "`omnihil models --keys` lists them" : fmt::format("did you mean \"{}\"?", near);
  }

  void settle_units() {
    for (Channel& channel : dataset_.channels) {
      const SignalRow& row = *find_signal(*dataset_.rig, channel.signal);
      const std::string_view unit = signal_unit(row, dataset_.linear);
      const TextPlace at{channel.line, 1};
      if (unit.empty()) {
        problem(at, "channels." + channel.signal, "", "has no meaning on a linear axis",
                "allowed there: motor_torque (N), position (m), velocity (m/s), …");
      } else if (!channel.unit.empty() && channel.unit != unit) {
        problem(at, "channels." + channel.signal + ".unit", fmt::format("\"{}\"", channel.unit),
                "is not this signal's unit",
                fmt::format("allowed: \"{}\"; convert with scale (signal = column * scale + offset)", unit));
      }
      channel.unit = unit;
    }
  }

  // Every run shows some motion, and something is left for the model to explain.
  void check_signals() {
    for (std::size_t r = 0; r < dataset_.runs.size(); ++r) {
      const Run& run = dataset_.runs[r];
      bool motion = false, compared = false;
      for (const auto& [name, values] : run.signals) {
        const SignalRow& row = *find_signal(*dataset_.rig, name);
        const bool moves = row.role == SignalRole::kMotion || row.role == SignalRole::kCounts;
        motion = motion || moves;
        compared = compared || ((moves || name == "load_torque") && !dataset_.channel(name)->imposed);
      }
      const TextPlace at = plan_.runs[r].at;
      const bool commanded = std::any_of(run.signals.begin(), run.signals.end(), [](const auto& signal) {
        return signal.first.starts_with("command_");
      });
      if (run.steady && commanded && dataset_.rig != &rig_axis())
        problem(at, "runs", fmt::format("\"{}\"", run.file), "is of settled points under commands",
                "duties: what a closed loop settles at is what it was told");
      if (!motion && !run.steady) {
        problem(at, "runs", fmt::format("\"{}\"", run.file), "has no motion signal",
                std::string(dataset_.rig->motion_needed));
      } else if (!compared && !run.steady) {
        problem(at, "runs", fmt::format("\"{}\"", run.file), "leaves nothing to compare",
                "where the speed is imposed, load_torque must be measured");
      }
    }
  }

  // As many of each signal per wheel as the model has wheels.
  void check_wheels() {
    const char* const kOtherNumber = "has another number of wheels than the dataset";
    const std::size_t wheels = wheel_count(out_.nominal->file.parameters);
    for (const char* const signal : {"duty", "command_wheel"}) {
      std::size_t given = 0;
      for (const std::string& name : per_wheel(signal, kMaxWheels))
        given += dataset_.channel(name) != nullptr ? 1u : 0u;
      need(given == 0 || given == wheels, "robot.wheel_angle_deg",
           fmt::format("the model has {} wheels, and the dataset {} channels {}_1, {}_2 …", wheels, given,
                       signal, signal),
           kOtherNumber);
    }
    for (const Channel& channel : dataset_.channels) {
      const std::size_t at = channel.signal.size() - 1;
      const bool numbered =
          at > 0 && channel.signal[at - 1] == '_' && channel.signal[at] >= '1' && channel.signal[at] <= '9';
      if (!numbered) continue;
      const auto wheel = static_cast<std::size_t>(channel.signal[at] - '0');
      need(wheel <= wheels, "robot.wheel_angle_deg",
           fmt::format("the model has {} wheels, and the dataset a channel {}", wheels, channel.signal),
           kOtherNumber);
    }
  }

  bool by_radio() const {
    return dataset_.rig->whole_robot &&
           std::any_of(dataset_.runs.begin(), dataset_.runs.end(),
                       [](const Run& run) { return run.signal("duty_1") == nullptr; });
  }

  // Of the command line, else the dataset's own. A board belongs to its image: another firmware may be a library.
  DatasetFirmware chosen_firmware() const {
    const auto beside = [this](const std::string& file) {
      return file.empty() ? file : (fs::path(folder_) / file).lexically_normal().string();
    };
    DatasetFirmware chosen{
        .file = other_firmware_.file, .board = other_firmware_.board, .radio = plan_.radio};
    if (chosen.file.empty()) chosen.file = beside(plan_.firmware);
    const bool own = other_firmware_.file.empty() || is_image(chosen.file);
    if (chosen.board.empty() && own) chosen.board = beside(plan_.board);
    chosen.boot_s = plan_.boot_s.value_or(chosen.boot_s);
    return chosen;
  }

  void read_firmware() {
    const DatasetFirmware chosen = chosen_firmware();
    const auto refuse = [&](const std::string& key, std::string what, std::string allowed) {
      const bool board = key == "board", radio = key == "radio";
      const std::string& value = board ? chosen.board : radio ? chosen.radio : chosen.file;
      problem(board && !plan_.board.empty() ? plan_.board_at
              : radio                       ? plan_.radio_at
                                            : plan_.firmware_at,
              key, fmt::format("\"{}\"", value), std::move(what), std::move(allowed));
    };
    if (!other_firmware_.format.empty()) {
      const RadioFile radio = load_radio_file(other_firmware_.format);
      out_.problems.insert(out_.problems.end(), radio.problems.begin(), radio.problems.end());
      if (radio.format == nullptr) return;
      use_radio_format(*radio.format);
    }
    if (chosen.file.empty()) {
      if (!chosen.board.empty()) refuse("board", "has nothing to do", "a firmware beside it, an image");
      return;
    }
    if (!by_radio())
      return refuse("firmware", "has nothing to do",
                    "a robot's commands without duties, for which a firmware makes them");
    if (wheel_count(out_.nominal->file.parameters) != kWheels)
      return refuse("firmware", "drives four wheels", "a model with four wheels");
    std::vector<FirmwareRefusal> refused;
    dataset_.firmware =
        open_dataset_firmware(chosen, robot_config(*out_.nominal->file.robot, 0), dataset_.runs, refused);
    for (FirmwareRefusal& r : refused) refuse(r.key, std::move(r.what), std::move(r.allowed));
    if (!dataset_.firmware) return;
    const bool said = out_.nominal->file.parameters.find("encoder.counts_per_turn") != nullptr;
    dataset_.notes.push_back(
        fmt::format("{} makes the duties, by encoders of {:g} counts a turn{}; of [controller] {}",
                    dataset_.firmware->fresh()->name(), dataset_.firmware->counts_per_rotor_turn(),
                    said ? "" : " (the model does not say: encoder.counts_per_turn)",
                    chosen.board.empty()
                        ? "the latency alone counts"
                        : "latency_s counts, and report_filter_s where its telemetry tells no wheel speeds"));
  }

  // Duties of radio commands are made by the firmware, or by the model's [controller].
  void check_robot_drive() {
    if (!chosen_firmware().file.empty()) return;
    const ParameterTable& table = out_.nominal->file.parameters;
    const auto given = [&](const char* path) { return table.value_or(path, 0.0) > 0.0; };
    bool by_radio = false, by_body = false;
    for (const Run& run : dataset_.runs) {
      by_radio = by_radio || run.signal("duty_1") == nullptr;
      by_body = by_body || (run.signal("duty_1") == nullptr && run.signal("command_vx") != nullptr);
    }
    check_wheels();
    need(!by_radio || given("controller.kp_V_s_per_rad") || given("controller.feedforward_V_s_per_rad"),
         "controller.kp_V_s_per_rad",
         "the robot is driven by radio commands: [controller] says what the firmware makes of them, or log "
         "duty_1 to "
         "duty_4 beside them");
    need(!by_body || given("controller.wheel_radius_m"), "controller.wheel_radius_m",
         "commands of the body's velocity become wheel speeds by the firmware's own constants");
    need(!by_body || given("controller.wheel_center_radius_m"), "controller.wheel_center_radius_m",
         "commands of the body's velocity become wheel speeds by the firmware's own constants");
  }

  // What the drive input needs of the model.
  void check_model() {
    if (dataset_.rig->whole_robot) return check_robot_drive();
    for (const GivenSignal& given : dataset_.rig->given) {
      for (std::size_t r = 0; r < dataset_.runs.size(); ++r) {
        if (dataset_.runs[r].signal(given.signal) == nullptr)
          problem(plan_.runs[r].at, "runs", fmt::format("\"{}\"", dataset_.runs[r].file),
                  fmt::format("has no {}", given.signal), std::string(given.what));
      }
    }
    if (dataset_.rig->of_robot) return;
    const ParameterTable& table = out_.nominal->file.parameters;
    const auto has = [&](const char* path) { return table.value_or(path, 0.0) > 0.0; };
    const bool constant = has("motor.torque_constant_Nm_per_A") || has("motor.torque_constant_N_per_A");
    bool supply_measured = true, electric = false, by_bus = false, servo = false, current = false;
    for (const Run& run : dataset_.runs) {
      const bool target = run.signal("position_target") != nullptr, duty = run.signal("duty") != nullptr;
      servo = servo || target;
      by_bus = by_bus || target || duty;
      electric = electric || target || duty || run.signal("motor_voltage") != nullptr;
      const Channel* amps = dataset_.channel("motor_current");
      current = current || (amps != nullptr && amps->imposed && run.signal("motor_current") != nullptr);
      supply_measured = supply_measured && (run.signal("bus_voltage") != nullptr || !(target || duty));
    }
    need(!electric || has("motor.resistance_ohm"), "motor.resistance_ohm",
         "a drive by duty, voltage or position target needs the winding's resistance");
    need(!(electric || current) || constant,
         dataset_.linear ? "motor.torque_constant_N_per_A" : "motor.torque_constant_Nm_per_A",
         "this drive input needs the torque constant");
    need(!by_bus || supply_measured || has("supply.voltage_V") || has("datasheet.nominal_voltage_V"),
         "supply.voltage_V", "not every run has a bus_voltage, so the model's is needed");
    need(!servo || has("servo.kp_duty_per_rad"), "servo.kp_duty_per_rad",
         "a drive by position_target needs the servo's gain");
  }

  void need(bool good, std::string path, std::string why, std::string what = "is missing") {
    if (good) return;
    out_.problems.push_back({.file = model_file_,
                             .line = 1,
                             .column = 1,
                             .key = std::move(path),
                             .value = "",
                             .what = std::move(what),
                             .allowed = std::move(why)});
  }

  std::string asked_, other_model_;
  OtherFirmware other_firmware_;
  std::string toml_, folder_, model_file_;
  DatasetPlan plan_;
  Dataset dataset_;
  DatasetReading out_;
};

}  // namespace

DatasetReading read_dataset(const std::string& path, const std::string& model,
                            const OtherFirmware& firmware) {
  return DatasetReader(path, model, firmware).read();
}

}  // namespace omnihil
