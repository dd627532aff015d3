// `omnihil convert`: a recording, or a capture of another tool, in another form.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "hil/acquire/tapped_dataset.h"
#include "hil/dataset/dataset_export.h"
#include "hil/dataset/dataset_model.h"
#include "hil/dataset/radio_export.h"
#include "hil/game_log/vision_csv.h"
#include "hil/recording/capture_import.h"
#include "hil/recording/heard_commands.h"
#include "hil/recording/mcap_export.h"
#include "hil/recording/pcap_export.h"
#include "hil/recording/recording_reader.h"
#include "hil/recording/session_setup.h"
#include "hil/recording/stream_file.h"
#include "hil/text/dataset_files.h"
#include "hil/text/program_files.h"
#include "hil/text/text_file.h"
#include "tools/command_line.h"
#include "tools/convert_capture.h"
#include "tools/exit_codes.h"
#include "tools/format_argument.h"
#include "tools/guarded.h"
#include "tools/packet_json.h"
#include "tools/verbs/verbs.h"

namespace omnihil {
namespace {

struct ConvertWords {
  std::string recording, format_file, radio;
  CaptureWords capture;
  std::string to = "dataset";
  std::string out;
  std::string drive = "duties", model;
  int robot = -1;
  double camera_Hz = 60.0;
};

std::optional<int> chosen_robot(const ConvertWords& words, const RecordingHeader& header) {
  if (words.robot < 0) return std::nullopt;
  const auto& ids = header.robot_ids;
  if (std::find(ids.begin(), ids.end(), words.robot) == ids.end()) {
    throw std::invalid_argument(
        fmt::format("--robot: found {}, allowed: {}", words.robot, fmt::join(ids, ", ")));
  }
  return words.robot;
}

void write_dataset(const ConvertWords& words, const DatasetExport& made) {
  NewFolder folder(words.out);
  for (const DatasetFile& file : made.files) folder.write(file.name, file.text);
  folder.finish();
  fmt::print("{}: {} rows in {} runs\n", words.out, made.rows, made.files.size() - 2);
  for (const std::string& note : made.notes) fmt::print("note: {}\n", note);
}

// A recording of `tap`: a real robot, of which the bytes are known and what the cameras saw beside them.
void tapped_to_dataset(const ConvertWords& words, const Recording& recording) {
  if (words.model.empty() || words.robot < 0)
    throw std::invalid_argument(
        "a tapped recording needs --robot and --model (with [controller], docs/radio-driven.md)");
  const StoredModel stored = load_robot_model(words.model, {data_folder("models")});
  if (!stored.model) throw std::invalid_argument(lines_of(stored.problems));
  const RadioFormat* format = format_or_complain(recording.header.radio_format);
  if (format == nullptr) throw std::invalid_argument("the commands of this recording cannot be read");
  TappedOptions options{.robot = *chosen_robot(words, recording.header), .model_text = {}, .vision_csv = {}};
  options.model_text =
      stored.bundle.motor_text.empty() ? stored.bundle.robot_text : dataset_model_text(*stored.model);
  if (const std::string seen = words.recording + ".vision.csv"; std::filesystem::exists(seen)) {
    std::string error;
    options.vision_csv = read_text_file(seen, error);
    if (!error.empty()) throw std::invalid_argument(seen + ": " + error);
  }
  write_dataset(words, tapped_dataset(recording, *format, options));
}

void to_dataset(const ConvertWords& words, const Recording& recording) {
  if (is_tapped(recording)) return tapped_to_dataset(words, recording);
  const ModelReading reading = read_bundle(session_setup(recording.header).model);
  if (!reading.model) throw std::invalid_argument(lines_of(reading.problems));
  const std::optional<int> robot = chosen_robot(words, recording.header);
  const auto make = [&] {
    if (words.drive == "duties")
      return make_dataset(recording, *reading.model, {.robot = robot, .camera_Hz = words.camera_Hz});
    const RadioFormat* format = format_or_complain(recording.header.radio_format);
    if (format == nullptr) throw std::invalid_argument("the commands of this recording cannot be read");
    return make_radio_dataset(recording, *reading.model, heard_commands(recording, *format),
                              {.robot = robot, .camera_Hz = words.camera_Hz});
  };
  write_dataset(words, make());
}

int run_convert_capture(const ConvertWords& words) {
  const RadioFormat* format = nullptr;
  if (!words.radio.empty() || !words.format_file.empty()) {
    format = format_or_complain(words.radio, words.format_file);
    if (format == nullptr) return kExitBadInput;
  }
  convert_capture(words.recording, words.to, words.out, words.capture, format);
  return kExitOk;
}

int run_convert_game(const ConvertWords& words) {
  if (words.to != "csv")
    throw std::invalid_argument("--to: found " + words.to + ", allowed for a game log: csv");
  GameLogReader log(words.recording);
  const VisionCsv csv = vision_csv(log);
  write_new_file(words.out, csv.text);
  print_notes(log.notes());
  fmt::print("{}: {} frames of vision, {} robots, {} balls; {} other records\n", words.out, csv.frames,
             csv.robots, csv.balls, csv.other_records);
  return kExitOk;
}

int run_convert(const ConvertWords& words) {
  if (is_game_log(words.recording)) return run_convert_game(words);
  if (is_capture_file(words.recording)) return run_convert_capture(words);
  const Recording recording = load_recording(std::filesystem::path(words.recording));
  if (words.to == "dataset") {
    to_dataset(words, recording);
  } else if (words.to == "csv") {
    write_new_file(words.out, wide_csv(recording, chosen_robot(words, recording.header)));
    fmt::print("{}: written\n", words.out);
  } else if (words.to == "candump" || words.to == "asc") {
    write_pieces(pieces_of(recording), words.to, words.out);
  } else if (words.to == "pcap" || words.to == "pcapng" || words.to == "mcap") {
    if (!words.format_file.empty() && format_file_or_complain(words.format_file) == nullptr)
      return kExitBadInput;
    const RadioFormat* format = format_or_complain(recording.header.radio_format);
    if (format == nullptr) return kExitBadInput;
    if (words.to == "pcapng") {
      write_pieces(packets_of(recording, *format), words.to, words.out);
      return kExitOk;
    }
    const std::string bytes =
        words.to == "pcap" ? pcap_of(recording, *format) : mcap_of(recording, *format, packet_to_json);
    write_new_file(words.out, bytes);
    fmt::print("{}: {} bytes\n", words.out, bytes.size());
  } else {
    const HostStream stream = stream_of(recording);
    if (stream.chunks.empty()) throw std::invalid_argument("the recording has no bytes of a host");
    write_new_file(words.out, to_text(stream, "what a host wrote to " + recording.header.radio_format));
    fmt::print("{}: {} writes, {} bytes\n", words.out, stream.chunks.size(), stream.byte_count());
  }
  if (recording.last_line_cut) fmt::print("note: the recording was cut off; its last line was left out\n");
  return kExitOk;
}

}  // namespace

void add_verb_convert(Verb& program, VerbResult& result) {
  auto words = std::make_shared<ConvertWords>();
  Verb verb = program.add_subcommand(
      "convert",
      "a recording or a capture as a dataset, CSV, stream to play, capture for other tools, or MCAP");
  verb.add_option("FILE", words->recording,
                  "recording that serve --record wrote; candump, asc, pcap, pcapng, CSV of time and hex; a "
                  "league's game log "
                  "(.log, .log.gz)")
      .required();
  verb.add_option(
          "--to", words->to,
          "dataset: a folder with dataset.toml, model.toml and one CSV per run; csv; stream; pcapng, pcap "
          "(Wireshark; pcap without ways); mcap (Foxglove, PlotJuggler); candump, asc (CAN tools). Of a "
          "capture: "
          "csv, stream, pcapng, candump, asc")
      .one_of({"dataset", "csv", "stream", "pcap", "pcapng", "mcap", "candump", "asc"})
      .required();
  verb.add_option("--out", words->out, "folder (dataset) or file to make; what is there is never overwritten")
      .required();
  verb.add_option("--format", words->format_file,
                  "radio format of the recording from this file, where it was made with one");
  verb.add_option("--radio", words->radio,
                  "radio format of a capture that does not say which way its bytes went");
  add_capture_options(verb, words->capture);
  verb.add_option("--robot", words->robot, "one robot only (default: all)").range(0, 255);
  verb.add_option(
          "--drive", words->drive,
          "of a dataset: duties, with all that a board measures; commands, with what a team's radio and a "
          "camera tell: reported wheel speeds and pose")
      .one_of({"duties", "commands"})
      .capture_default_str();
  verb.add_option("--model", words->model,
                  "of a tapped recording: the robot's model that goes with the data, a name or a .toml file");
  verb.add_option("--camera-hz", words->camera_Hz, "rate of the vision columns of a dataset")
      .range(0.1, 10000.0)
      .capture_default_str();
  verb.footer(
      "A dataset of several robots has a run each, the last held out; of one robot, the last third of its "
      "time is\n"
      "held out. Nothing is left half written. For a measurement, record every tick (serve --sample-every "
      "1).");
  verb.callback(
      [words, &result] { result.exit_code = guarded("convert", [&] { return run_convert(*words); }); });
}

}  // namespace omnihil
