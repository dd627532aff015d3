#include "hil/dataset/radio_export.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "firmware_iface/reference/reference_firmware.h"
#include "firmware_iface/reference/wheel_tuning.h"
#include "hil/dataset/dataset_model.h"
#include "hil/loop/session_checks.h"
#include "hil/text/recording_text.h"
#include "sim/bench/dataset_text.h"
#include "sim/model/model_writer.h"

namespace omnihil {
namespace {

constexpr std::string_view kReferenceName = "omnihil reference wheel controller";

using RobotSamples = std::vector<const RecordedChunk*>;

std::size_t sample_column(const RecordingHeader& header, const std::string& name) {
  const auto at = std::find(header.columns.begin(), header.columns.end(), name);
  if (at == header.columns.end()) throw std::invalid_argument("the recording has no column '" + name + "'");
  return static_cast<std::size_t>(at - header.columns.begin());
}

bool by_wheels(const RobotCommand& c) { return c.mode == OMNIHIL_MODE_WHEEL_SPEED; }
bool can_be_told(const RobotCommand& c) {
  const bool body = c.mode == OMNIHIL_MODE_BODY_VELOCITY &&
                    (c.flags & (OMNIHIL_COMMAND_FIELD_FRAME | OMNIHIL_COMMAND_YAW_TARGET)) == 0;
  return body || by_wheels(c);
}

class RadioRuns {
 public:
  RadioRuns(const RecordingHeader& header, bool wheels, const RadioDatasetOptions& options)
      : wheels_(wheels), options_(options) {
    for (std::size_t i = 0; i < kWheels; ++i)
      speed_[i] = sample_column(header, "feedback_omega_wheel_rad_s_" + std::to_string(i + 1));
    const bool seen =
        std::find(header.columns.begin(), header.columns.end(), "vision_x_m") != header.columns.end();
    pose_ = {sample_column(header, seen ? "vision_x_m" : "true_x_m"),
             sample_column(header, seen ? "vision_y_m" : "true_y_m"),
             sample_column(header, seen ? "vision_yaw_rad" : "true_yaw_rad")};
  }

  // The first sample at or after a command, a telemetry period's end or a camera frame is a row.
  std::string csv(std::span<const RecordedChunk* const> samples, std::span<const HeardCommand> commands) {
    std::string text =
        wheels_ ? "time_s,wheel_cmd_1,wheel_cmd_2,wheel_cmd_3,wheel_cmd_4" : "time_s,cmd_vx,cmd_vy,cmd_w";
    text += ",wheel_1,wheel_2,wheel_3,wheel_4,vision_x,vision_y,vision_theta\n";
    const HeardCommand* said = nullptr;
    std::size_t next = 0;
    std::int64_t last_frame = -1, last_report = -1;
    for (const RecordedChunk* sample : samples) {
      const double time_s = 1e-9 * static_cast<double>(sample->now_ns);
      const auto report = static_cast<std::int64_t>(std::floor(time_s / options_.telemetry_period_s + 1e-9));
      const auto frame = static_cast<std::int64_t>(std::floor(time_s * options_.camera_Hz + 1e-9));
      const HeardCommand* heard = nullptr;
      for (; next < commands.size() && commands[next].now_ns <= sample->now_ns; ++next)
        heard = &commands[next];
      if (said == nullptr && heard == nullptr) continue;  // the record begins with the first command
      if (heard == nullptr && report == last_report && frame == last_frame) continue;
      if (heard != nullptr) said = heard;
      append_number(text, time_s);
      command(text, heard);
      for (const std::size_t place : speed_)
        cell(text, report != last_report ? &sample->sample[place] : nullptr);
      for (const std::size_t place : pose_)
        cell(text, frame != last_frame ? &sample->sample[place] : nullptr);
      text += '\n';
      ++rows_;
      last_report = report, last_frame = frame;
    }
    return text;
  }
  std::size_t rows() const { return rows_; }

 private:
  static void cell(std::string& text, const double* value) {
    text += ',';
    if (value != nullptr) append_number(text, *value);
  }
  void command(std::string& text, const HeardCommand* heard) const {
    if (heard == nullptr) return void(text += wheels_ ? ",,,," : ",,,");
    const RobotCommand& c = heard->command;
    if (wheels_) {
      for (const double& w : c.omega_wheel_rad_s) cell(text, &w);
      return;
    }
    for (const double* v : {&c.v_forward_m_s, &c.v_left_m_s, &c.omega_body_rad_s}) cell(text, v);
  }

  bool wheels_;
  RadioDatasetOptions options_;
  std::array<std::size_t, kWheels> speed_{};
  std::array<std::size_t, 3> pose_{};
  std::size_t rows_ = 0;
};

}  // namespace

std::string reference_controller_text(const RobotModel& model) {
  const RobotConfig config = robot_config(model, 0);
  const double period_s = 1e-6 * static_cast<double>(REFERENCE_PERIOD_US);
  wheel_tuning t;
  wheel_tuning_init(&t, &config, static_cast<float>(period_s));
  const double gear = static_cast<double>(t.gear_ratio), radius_m = model.wheel_radius_m;
  // R / k times the inertia that a wheel has to speed up with its share of the body, as its own tuning takes it
  const double inertia = static_cast<double>(t.inertia_free_kg_m2) +
                         static_cast<double>(t.mass_kg) * radius_m * radius_m / (2.0 * gear * gear);
  const double k = static_cast<double>(t.motor.torque_constant_Nm_per_A);
  return fmt::format(
      "\n[controller]\nkp_V_s_per_rad = {:.6g}\nki_V_per_rad = {:.6g}\nfeedforward_V_s_per_rad = {:.6g}\n"
      "acceleration_feedforward_V_s2_per_rad = {{ value = {:.4g}, tolerance = 0.3, source = \"the share of "
      "the body "
      "differs by direction\" }}\nintegral_limit_ratio = 0.5\nspeed_filter_s = {:.4g}\nreport_filter_s = "
      "{:.4g}\n"
      "acceleration_limit_m_s2 = 4.0\nyaw_acceleration_limit_rad_s2 = 60.0\nplanned_grip = "
      "0.55\nrate_limit_rad_s2 = "
      "{:.6g}\nperiod_s = {:g}\n"
      "latency_s = {{ value = 0.003, tolerance = 1.0, source = \"of the dongle\" }}\nwheel_radius_m = {:g}\n"
      "wheel_center_radius_m = {:g}\n",
      static_cast<double>(t.gains.p_V_s_per_rad), static_cast<double>(t.gains.i_V_per_rad), k,
      static_cast<double>(t.motor.resistance_ohm) / k * inertia, static_cast<double>(t.encoder.filter_s),
      static_cast<double>(t.encoder.report_filter_s), 4.0 / radius_m * gear, period_s, radius_m,
      model.wheel_center_radius_m);
}

namespace {

std::string radio_dataset_text(const RecordingHeader& header, bool wheels,
                               const std::vector<std::pair<std::string, const char*>>& runs) {
  std::string text = dataset_head("simulated " + header.robot_model + " by radio, " + header.radio_format +
                                      ", " + header.firmware + ", commit " + header.commit,
                                  "robot", header.radio_format);
  const auto channel = [&](const std::string& signal, const std::string& column) {
    text += channel_line(signal, column);
  };
  for (const char* axis : {"vx", "vy", "w"}) {
    if (!wheels) channel(std::string("command_") + axis, std::string("cmd_") + axis);
  }
  for (const char* wheel : {"1", "2", "3", "4"}) {
    if (wheels) channel(std::string("command_wheel_") + wheel, std::string("wheel_cmd_") + wheel);
  }
  for (const char* wheel : {"1", "2", "3", "4"})
    channel(std::string("wheel_speed_") + wheel, std::string("wheel_") + wheel);
  for (const char* same : {"vision_x", "vision_y", "vision_theta"}) channel(same, same);
  for (const auto& [file, use] : runs) text += run_lines(file, use, "recorded host");
  return text;
}

}  // namespace

DatasetExport make_radio_dataset(const Recording& recording, const ModelFile& model,
                                 std::span<const HeardCommand> commands, const RadioDatasetOptions& options) {
  if (!model.robot) throw std::invalid_argument("the recording's model is no robot");
  const std::vector<int> ids = options.robot ? std::vector<int>{*options.robot} : recording.header.robot_ids;
  std::vector<HeardCommand> told;
  std::size_t left_out = 0, wheels = 0;
  for (const HeardCommand& c : commands) {
    if (std::find(ids.begin(), ids.end(), c.robot_id) == ids.end()) continue;
    if (!can_be_told(c.command)) {
      ++left_out;
      continue;
    }
    wheels += by_wheels(c.command) ? 1 : 0;
    told.push_back(c);
  }
  if (told.empty())
    throw std::invalid_argument(
        "no command of a body's velocity in its own frame, or of wheel speeds, was sent");
  const bool wheel_speeds = 2 * wheels > told.size();
  left_out +=
      std::erase_if(told, [&](const HeardCommand& c) { return by_wheels(c.command) != wheel_speeds; });
  RadioRuns writer(recording.header, wheel_speeds, options);
  DatasetExport made;
  std::vector<std::pair<std::string, const char*>> runs;
  std::vector<DatasetFile> tables;
  for (const int id : ids) {
    RobotSamples samples;
    std::vector<HeardCommand> own;
    for (const RecordedChunk& chunk : recording.chunks) {
      if (chunk.kind == RecordedChunk::Kind::kSample && chunk.robot_id == id) samples.push_back(&chunk);
    }
    std::copy_if(told.begin(), told.end(), std::back_inserter(own),
                 [&](const HeardCommand& c) { return c.robot_id == id; });
    if (samples.empty() || own.empty())
      throw std::invalid_argument(
          fmt::format("the recording has no {} of robot {}", own.empty() ? "commands" : "samples", id));
    const std::span<const RecordedChunk* const> all(samples);
    const auto held_out = static_cast<std::size_t>(static_cast<double>(all.size()) * options.holdout_ratio);
    const auto add = [&](const char* part, const char* use, std::span<const RecordedChunk* const> piece) {
      runs.emplace_back(fmt::format("robot_{}{}.csv", id, part), use);
      tables.push_back({runs.back().first, writer.csv(piece, own)});
    };
    if (ids.size() > 1 || held_out == 0) {
      add("", ids.size() > 1 && id == ids.back() ? "holdout" : "fit", all);
    } else {
      add("_fit", "fit", all.first(all.size() - held_out));
      add("_holdout", "holdout", all.last(held_out));
    }
  }
  made.rows = writer.rows();
  if (left_out > 0)
    made.notes.push_back(
        fmt::format("{} commands are left out: in the field's frame, to a heading, of duties, or of "
                    "another kind than most",
                    left_out));
  std::string text = dataset_model_text(model);
  if (recording.header.firmware.starts_with(kReferenceName)) {
    text += reference_controller_text(*model.robot);
  } else {
    made.notes.push_back("model.toml has no [controller]: write in what the firmware makes of commands");
  }
  made.files = {{"dataset.toml", radio_dataset_text(recording.header, wheel_speeds, runs)},
                {"model.toml", std::move(text)}};
  std::move(tables.begin(), tables.end(), std::back_inserter(made.files));
  return made;
}

}  // namespace omnihil
