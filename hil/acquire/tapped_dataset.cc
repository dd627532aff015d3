#include "hil/acquire/tapped_dataset.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <sstream>
#include <stdexcept>

#include "hil/acquire/acquired_dataset.h"
#include "hil/recording/recorded_packets.h"

namespace omnihil {

std::optional<std::pair<PlanDrive, SentCommand>> told_by_dataset(const HeardCommand& heard) {
  const RobotCommand& c = heard.command;
  SentCommand sent{.now_ns = heard.now_ns, .value = {}, .in_field = false};
  if (c.mode == OMNIHIL_MODE_WHEEL_SPEED) {
    std::copy(std::begin(c.omega_wheel_rad_s), std::end(c.omega_wheel_rad_s), sent.value.begin());
    return std::pair(PlanDrive::kWheelSpeed, sent);
  }
  if (c.mode != OMNIHIL_MODE_BODY_VELOCITY || (c.flags & OMNIHIL_COMMAND_YAW_TARGET) != 0)
    return std::nullopt;
  sent.value = {c.v_forward_m_s, c.v_left_m_s, c.omega_body_rad_s, 0.0};
  sent.in_field = (c.flags & OMNIHIL_COMMAND_FIELD_FRAME) != 0;
  return std::pair(PlanDrive::kBodyVelocity, sent);
}

namespace {

void read_vision(const std::string& csv, Team team, int robot, RunLog& log) {
  std::istringstream lines(csv);
  std::string line;
  while (std::getline(lines, line)) {
    SeenFrame f;
    std::array<char, 8> name{};
    int id = -1;
    if (std::sscanf(line.c_str(), "%lf,%u,%7[a-z],%d,%lf,%lf,%lf", &f.capture_s, &f.camera, name.data(), &id,
                    &f.x_m, &f.y_m, &f.yaw_rad) != 7)
      continue;  // the header
    if (id != robot || (std::string_view(name.data()) == "blue") != (team == Team::kBlue)) continue;
    log.seen.push_back(f);
    if (log.cameras[f.camera].messages() == 0)
      log.cameras[f.camera].add(f.capture_s, f.capture_s);  // one clock already
  }
}

}  // namespace

bool is_tapped(const Recording& recording) {
  return std::none_of(recording.chunks.begin(), recording.chunks.end(),
                      [](const RecordedChunk& c) { return c.kind == RecordedChunk::Kind::kSample; });
}

DatasetExport tapped_dataset(const Recording& recording, const RadioFormat& format, const TappedOptions& o) {
  std::array<std::vector<SentCommand>, 2> sent;  // by PlanDrive
  std::size_t left_out = 0;
  for (const HeardCommand& heard : heard_commands(recording, format)) {
    if (heard.robot_id != o.robot) continue;
    const auto told = told_by_dataset(heard);
    if (!told) {
      ++left_out;
    } else {
      sent[static_cast<std::size_t>(told->first)].push_back(told->second);
    }
  }
  const bool wheels = sent[1].size() > sent[0].size();
  left_out += sent[wheels ? 0 : 1].size();
  RunLog log;
  log.sent = std::move(sent[wheels ? 1 : 0]);
  if (log.sent.empty())
    throw std::invalid_argument(fmt::format(
        "robot {} was asked for no velocity of its body and for no wheel speeds ({} commands of other kinds)",
        o.robot, left_out));
  for (const RecordedPacket& packet : dongle_packets(recording, format)) {
    if (!packet.frame.understood) continue;
    const auto told = telemetry_of(format, format.decode(packet.frame.bytes).values);
    if (told && (told->robot_id < 0 || told->robot_id == o.robot)) log.told.push_back({packet.now_ns, *told});
  }
  read_vision(o.vision_csv, recording.header.team, o.robot, log);
  const std::int64_t from_ns = log.sent.front().now_ns, to_ns = log.sent.back().now_ns;
  const auto cut_ns =
      to_ns - static_cast<std::int64_t>(static_cast<double>(to_ns - from_ns) * o.holdout_ratio);

  AcquirePlan plan;
  plan.title = "tapped, robot " + std::to_string(o.robot);
  plan.drive = wheels ? PlanDrive::kWheelSpeed : PlanDrive::kBodyVelocity;
  plan.runs = {
      {.name = "fit", .use = Split::kTraining, .excitation = "played host", .duration_s = 0.0, .steps = {}},
      {.name = "holdout",
       .use = Split::kValidation,
       .excitation = "played host",
       .duration_s = 0.0,
       .steps = {}}};
  std::vector<AcquiredRun> runs;
  for (const PlanRun& run : plan.runs) {
    const bool fit = run.use == Split::kTraining;
    log.driving_from_ns = fit ? from_ns : cut_ns + static_cast<std::int64_t>(kLead_s * 1e9);
    log.end_ns = fit ? cut_ns : to_ns;
    runs.push_back({&run, run_rows(log, plan.drive)});
  }
  DatasetExport made;
  made.files = {
      {"dataset.toml", acquired_dataset_text(
                           plan, runs, steady_noise(plan, runs, wheel_speed_step_rad_s(format)), format.id)},
      {"model.toml", o.model_text}};
  for (const AcquiredRun& one : runs) {
    made.rows += one.rows.time_s.size();
    made.files.push_back({one.run->name + ".csv", rows_csv(one.rows)});
  }
  if (left_out > 0)
    made.notes.push_back(fmt::format(
        "{} commands are left out: to a heading, of duties, or of another kind than most", left_out));
  if (log.seen.empty()) made.notes.push_back("no pose: nothing beside the bytes was seen of this robot");
  return made;
}

}  // namespace omnihil
