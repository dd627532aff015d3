#include "hil/dataset/dataset_export.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "hil/dataset/dataset_model.h"
#include "hil/text/recording_text.h"
#include "sim/bench/dataset_text.h"
#include "sim/model/model_writer.h"

namespace omnihil {
namespace {

constexpr std::string_view kCsvHeader =
    "time_s,duty_1,duty_2,duty_3,duty_4,bus_V,current_1,ticks_1,current_2,ticks_2,current_3,ticks_3,"
    "current_4,ticks_4,gyro_z,accel_x,accel_y,vision_x,vision_y,vision_theta\n";

using Samples = std::vector<const RecordedChunk*>;

Samples samples_of(const Recording& recording, int robot) {
  Samples samples;
  for (const RecordedChunk& chunk : recording.chunks) {
    if (chunk.kind == RecordedChunk::Kind::kSample && chunk.robot_id == robot) samples.push_back(&chunk);
  }
  return samples;
}

std::size_t column_index(const RecordingHeader& header, const std::string& name) {
  const auto at = std::find(header.columns.begin(), header.columns.end(), name);
  if (at == header.columns.end()) throw std::invalid_argument("the recording has no column '" + name + "'");
  return static_cast<std::size_t>(at - header.columns.begin());
}

// Where the dataset's signals stand in a sample.
struct Places {
  std::array<std::size_t, kWheels> duty{}, mode{}, current{}, encoder{};
  std::size_t bus = 0, gyro = 0, accel_x = 0, accel_y = 0, x = 0, y = 0, yaw = 0;

  explicit Places(const RecordingHeader& header) {
    for (std::size_t i = 0; i < kWheels; ++i) {
      const std::string wheel = "_" + std::to_string(i + 1);
      duty[i] = column_index(header, "duty_ratio" + wheel);
      mode[i] = column_index(header, "drive_mode" + wheel);
      current[i] = column_index(header, "motor_current_A" + wheel);
      encoder[i] = column_index(header, "encoder_counts" + wheel);
    }
    bus = column_index(header, "bus_voltage_V");
    gyro = column_index(header, "gyro_z_rad_s");
    accel_x = column_index(header, "accel_x_m_s2");
    accel_y = column_index(header, "accel_y_m_s2");
    // recordings of before there were columns of the camera hold the true pose alone
    const bool seen =
        std::find(header.columns.begin(), header.columns.end(), "vision_x_m") != header.columns.end();
    x = column_index(header, seen ? "vision_x_m" : "true_x_m");
    y = column_index(header, seen ? "vision_y_m" : "true_y_m");
    yaw = column_index(header, seen ? "vision_yaw_rad" : "true_yaw_rad");
  }
};

class RunWriter {
 public:
  RunWriter(const RecordingHeader& header, double camera_Hz) : at_(header), camera_Hz_(camera_Hz) {}

  std::string csv(std::span<const RecordedChunk* const> samples) {
    text_ = kCsvHeader;
    last_frame_ = -1;
    for (const RecordedChunk* sample : samples) row(*sample);
    return std::move(text_);
  }
  std::size_t rows_coasting() const { return rows_coasting_; }

 private:
  void cell(double value) {
    text_ += ',';
    append_number(text_, value);
  }
  void row(const RecordedChunk& sample) {
    const std::vector<double>& v = sample.sample;
    const double time_s = static_cast<double>(sample.now_ns) / 1e9;
    append_number(text_, time_s);
    bool coasting = false;
    for (std::size_t i = 0; i < kWheels; ++i) {
      const bool driven = v[at_.mode[i]] == static_cast<double>(OMNIHIL_DRIVE_DUTY);
      driven ? cell(v[at_.duty[i]]) : void(text_ += ',');
      coasting = coasting || !driven;
    }
    rows_coasting_ += coasting ? 1 : 0;
    cell(v[at_.bus]);
    for (std::size_t i = 0; i < kWheels; ++i) {
      cell(v[at_.current[i]]);
      cell(v[at_.encoder[i]]);
    }
    for (const std::size_t place : {at_.gyro, at_.accel_x, at_.accel_y}) cell(v[place]);
    camera(v, time_s);
    text_ += '\n';
  }
  // The first row at or after each camera frame carries it.
  void camera(const std::vector<double>& v, double time_s) {
    const auto frame = static_cast<std::int64_t>(std::floor(time_s * camera_Hz_ + 1e-9));
    if (frame == last_frame_) {
      text_ += ",,,";
      return;
    }
    last_frame_ = frame;
    for (const std::size_t place : {at_.x, at_.y, at_.yaw}) cell(v[place]);
  }

  Places at_;
  double camera_Hz_;
  std::string text_;
  std::int64_t last_frame_ = -1;
  std::size_t rows_coasting_ = 0;
};

struct ExportedRun {
  std::string file;
  const char* use;
};

std::string dataset_text(const RecordingHeader& header, const ModelFile& model,
                         const std::vector<ExportedRun>& runs) {
  std::string text = dataset_head("simulated " + header.robot_model + ", " + header.radio_format + ", " +
                                      header.firmware + ", commit " + header.commit,
                                  "robot");
  const EncoderParams& encoder = model.robot->encoder;
  const std::string resolution = ", counts_per_rev = " + std::to_string(encoder.counts_per_turn) +
                                 ", shaft = \"rotor\"" + (encoder.direction < 0 ? ", scale = -1" : "");
  for (const char* wheel : {"1", "2", "3", "4"})
    text += channel_line(std::string("duty_") + wheel, std::string("duty_") + wheel);
  text += channel_line("bus_voltage", "bus_V");
  for (const char* wheel : {"1", "2", "3", "4"}) {
    text += channel_line(std::string("motor_current_") + wheel, std::string("current_") + wheel);
    text += channel_line(std::string("encoder_") + wheel, std::string("ticks_") + wheel, 0.0, resolution);
  }
  for (const char* same : {"gyro_z", "accel_x", "accel_y", "vision_x", "vision_y", "vision_theta"}) {
    text += channel_line(same, same);
  }
  for (const ExportedRun& run : runs) text += run_lines(run.file, run.use, "recorded host");
  return text;
}

std::string robot_file(int robot, const char* part) {
  return "robot_" + std::to_string(robot) + part + ".csv";
}

}  // namespace

DatasetExport make_dataset(const Recording& recording, const ModelFile& model,
                           const DatasetOptions& options) {
  if (!model.robot) throw std::invalid_argument("the recording's model is no robot");
  const std::vector<int> ids = options.robot ? std::vector<int>{*options.robot} : recording.header.robot_ids;
  RunWriter writer(recording.header, options.camera_Hz);
  DatasetExport made;
  std::vector<ExportedRun> runs;
  std::vector<DatasetFile> tables;
  for (const int id : ids) {
    const Samples samples = samples_of(recording, id);
    if (samples.empty())
      throw std::invalid_argument("the recording has no samples of robot " + std::to_string(id));
    made.rows += samples.size();
    const std::span<const RecordedChunk* const> all(samples);
    const auto held_out = static_cast<std::size_t>(static_cast<double>(all.size()) * options.holdout_ratio);
    if (ids.size() > 1 || held_out == 0) {
      const bool last = ids.size() > 1 && id == ids.back();
      runs.push_back({robot_file(id, ""), last ? "holdout" : "fit"});
      tables.push_back({runs.back().file, writer.csv(all)});
      continue;
    }
    runs.push_back({robot_file(id, "_fit"), "fit"});
    tables.push_back({runs.back().file, writer.csv(all.first(all.size() - held_out))});
    runs.push_back({robot_file(id, "_holdout"), "holdout"});
    tables.push_back({runs.back().file, writer.csv(all.last(held_out))});
  }
  if (recording.header.sample_every > 1) {
    made.notes.push_back("every " + std::to_string(recording.header.sample_every) +
                         "th tick was recorded: the drive between rows is not in the data; record every tick "
                         "for a measurement");
  }
  if (writer.rows_coasting() > 0) {
    made.notes.push_back(std::to_string(writer.rows_coasting()) +
                         " rows with bridges off: duty left empty there");
  }
  made.files = {{"dataset.toml", dataset_text(recording.header, model, runs)},
                {"model.toml", dataset_model_text(model)}};
  std::move(tables.begin(), tables.end(), std::back_inserter(made.files));
  return made;
}

std::string wide_csv(const Recording& recording, std::optional<int> robot) {
  std::string text = "time_s,robot_id";
  for (const std::string& column : recording.header.columns) text += "," + column;
  text += '\n';
  for (const RecordedChunk& chunk : recording.chunks) {
    if (chunk.kind != RecordedChunk::Kind::kSample || (robot && chunk.robot_id != *robot)) continue;
    append_number(text, static_cast<double>(chunk.now_ns) / 1e9);
    text += ',';
    append_integer(text, chunk.robot_id);
    for (const double value : chunk.sample) {
      text += ',';
      append_number(text, value);
    }
    text += '\n';
  }
  return text;
}

}  // namespace omnihil
