// Packets made by the teams' own programs, from the folder of reference data, as rows of one shape.
//
//   for (const TeamRow& row : team_rows("ibis-robot-command-v2")) …
//
// Each loader turns a file's own arrangement into rows; the names stay the team's.
#pragma once
#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/protocols/packet_util.h"

namespace omnihil {

struct TeamPacket {
  std::string name;
  nlohmann::json given;    // what was put in, as `encode` takes it
  nlohmann::json decoded;  // what the team's decoder says, as far as it says it
};

struct TeamRow {
  std::vector<TeamPacket> packets;  // one, but in frames that list packets
  std::string hex;                  // the whole frame
};

struct TeamFile {
  std::string format;
  std::size_t rows;  // that the file must have
  std::function<std::vector<TeamRow>(const std::function<nlohmann::json(const char*)>& file)> load;
};

inline std::vector<TeamRow> ibis_rows(const std::function<nlohmann::json(const char*)>& file) {
  using nlohmann::json;
  std::vector<TeamRow> rows;
  const json commands = file("ibis-robot-command-v2.json");
  for (const char* group : {"crane_vectors", "orion_vectors"}) {
    for (const json& row : commands.at(group)) {
      const json& said = row.at("decoded");
      const json decoded{
          {"vision_global_pos", {said.at("vision_x"), said.at("vision_y")}},
          {"vision_global_theta", said.at("vision_theta")},
          {"target_global_theta", said.at("target_theta")},
          {"kick_power", said.at("kick_power")},
          {"dribble_power", said.at("dribble_power")},
          {"acceleration_limit", said.at("acceleration_limit")},
          {"linear_velocity_limit", said.at("linear_velocity_limit")},
          {"angular_velocity_limit", said.at("angular_velocity_limit")},
          {"latency_time_ms", said.at("latency_time_ms").get<int>()},
          {"elapsed_time_ms_since_last_vision", said.at("elapsed_time_ms").get<int>()},
          {"control_mode", said.at("control_mode").get<int>()},
          {"check_counter", row.at("in").at("check_counter")},
          {"enable_chip", row.at("in").at("enable_chip")},
      };
      rows.push_back({{{row.at("mode"), row.at("in"), decoded}}, row.at("hex")});
    }
  }
  const json feedback = file("ibis-robot-feedback-128.json");
  for (const json& row : feedback.at("vectors")) {
    json fields = row.at("decoded");
    fields.erase("reserved");
    rows.push_back({{{"FEEDBACK", fields, fields}}, row.at("hex")});
  }
  return rows;
}

// Made from the CM4's document and the board's routine for the sum, not by running a program of theirs.
inline std::vector<TeamRow> ibis_uart_rows(const std::function<nlohmann::json(const char*)>& file) {
  using nlohmann::json;
  std::vector<TeamRow> rows;
  const json commands = file("ibis-robot-command-v2.json");
  for (const json& row : commands.at("uart72").at("vectors")) {
    const std::string command = row.at("command_hex");
    for (const TeamRow& known : ibis_rows(file)) {
      if (known.hex != command) continue;
      TeamPacket packet = known.packets[0];
      packet.given.erase("header");
      packet.given["camera"] = row.at("camera");
      packet.decoded["camera"] = row.at("camera");
      rows.push_back({{packet}, row.at("hex")});
      break;
    }
  }
  return rows;
}

// The network's commands with a robot's number before them, as its CM4 finds them in the datagram for all.
inline std::vector<TeamRow> ibis_broadcast_rows(const std::function<nlohmann::json(const char*)>& file) {
  constexpr int kRobots[] = {0, 1, 10, 155};
  std::vector<TeamRow> rows;
  for (TeamRow row : ibis_rows(file)) {
    if (row.packets[0].name == "FEEDBACK" || row.packets[0].given.at("header") != 0) continue;
    row.packets[0].given.erase("header");
    const int robot = kRobots[rows.size() % std::size(kRobots)];
    row.packets[0].given["robot_id"] = row.packets[0].decoded["robot_id"] = robot;
    row.hex = to_hex(Bytes{static_cast<std::uint8_t>(robot)}) + row.hex;
    rows.push_back(row);
  }
  return rows;
}

inline std::vector<TeamRow> ateam_rows(const std::function<nlohmann::json(const char*)>& file) {
  using nlohmann::json;
  std::vector<TeamRow> rows;
  constexpr const char* kFlags[] = {
      "power_error",           "tipped_error",          "breakbeam_error",       "breakbeam_ball_detected",
      "accelerometer_0_error", "accelerometer_1_error", "gyroscope_0_error",     "gyroscope_1_error",
      "motor_0_general_error", "motor_0_hall_error",    "motor_1_general_error", "motor_1_hall_error",
      "motor_2_general_error", "motor_2_hall_error",    "motor_3_general_error", "motor_3_hall_error",
      "motor_4_general_error", "motor_4_hall_error",    "chipper_available",     "kicker_available"};
  const json all = file("ateam-rnp-stspin-2025.json");
  for (const auto& [name, group] : all.at("vectors").items()) {
    for (const json& row : group) {
      json fields = row;
      fields.erase("bytes");
      if (name == "telemetry") {
        const auto bits = fields.at("flags").get<std::uint32_t>();
        json flags;
        for (std::size_t i = 0; i < std::size(kFlags); ++i) flags[kFlags[i]] = bits >> i & 1u;
        // Four of the bits by their members in the team's struct.
        EXPECT_EQ(fields.at("bits"), json({bits & 1u, bits >> 3 & 1u, bits >> 8 & 1u, bits >> 19 & 1u}));
        fields.erase("bits");
        fields["flags"] = flags;
      }
      if (name == "robot_parameter_command") {
        while (fields.at("values").size() < 25) fields["values"].push_back(0.0);
      }
      rows.push_back({{{name, fields, fields}}, row.at("bytes")});
    }
  }
  return rows;
}

inline std::vector<TeamRow> rhoban_rows(const std::function<nlohmann::json(const char*)>& file) {
  using nlohmann::json;
  std::vector<TeamRow> rows;
  const json all = file("rhoban-master-serial.json");
  for (const json& row : all.at("frames")) {
    TeamRow frame{.packets = {}, .hex = row.at("bytes")};
    for (json fields : row.at("packets")) {
      const std::string name = fields.at("kind");
      fields.erase("kind");
      frame.packets.push_back({name, fields, fields});
    }
    rows.push_back(frame);
  }
  for (const json& row : all.at("answers")) {
    TeamRow frame{.packets = {}, .hex = row.at("bytes")};
    for (json fields : row.at("robots")) {
      fields["robot"] = fields.at("id");
      frame.packets.push_back({"status", fields, fields});
    }
    rows.push_back(frame);
  }
  return rows;
}

inline std::vector<TeamRow> rocos_rows(const std::function<nlohmann::json(const char*)>& file) {
  using nlohmann::json;
  std::vector<TeamRow> rows;
  const json all = file("rocos-serial-25.json");
  for (const json& row : all.at("start_packets")) {
    const json frequency{{"frequency", row.at("frequency")}};
    rows.push_back({{{"start1", json::object(), json::object()}}, row.at("start1")});
    rows.push_back({{{"start2", frequency, frequency}}, row.at("start2")});
  }
  for (const json& row : all.at("packets")) {
    unsigned ids = 0;
    json given{{"robot", json::array()}};
    json decoded{{"robot", json::array()}};
    for (const json& robot : row.at("robots")) {
      ids |= 1u << robot.at("id").get<int>();
      json wanted = robot;
      wanted.erase("id");
      wanted["present"] = 1;
      // The host's map of kicks, as the file was made: at most 126.
      wanted["power"] = std::min(robot.at("power").get<double>(), 126.0);
      given["robot"].push_back(wanted);
      for (const char* speed : {"vx", "vy", "vr"}) {
        wanted[speed] = std::trunc(std::clamp(wanted.at(speed).get<double>(), -511.0, 511.0));
      }
      wanted["power"] = std::trunc(wanted.at("power").get<double>());
      const double dribble = std::clamp(wanted.at("dribble").get<double>(), 0.0, 1.0);
      wanted["dribble"] = std::trunc(3.0 * dribble + 0.4) / 3.0;
      decoded["robot"].push_back(wanted);
    }
    while (given["robot"].size() < 3) {
      given["robot"].push_back({{"present", 0}});
      decoded["robot"].push_back({{"present", 0}});
    }
    for (json* fields : {&given, &decoded}) {
      (*fields)["frequency"] = row.at("frequency");
      (*fields)["robots_15_to_8"] = ids >> 8;
      (*fields)["robots_7_to_0"] = ids & 0xFFu;
    }
    rows.push_back({{{"packets", given, decoded}}, row.at("hex")});
  }
  return rows;
}

inline std::vector<TeamRow> tigers_rows(const std::function<nlohmann::json(const char*)>& file) {
  using nlohmann::json;
  std::vector<TeamRow> rows;
  const json all = file("tigers-base-station.json");
  for (const char* group : {"match_ctrl", "match_feedback", "broadcast", "host"}) {
    for (const json& row : all.at(group)) {
      json fields = row;
      std::string name = group;
      if (name == "match_ctrl") name = row.at("skill");
      if (name == "host") name = row.at("name");
      for (const char* other : {"udp", "app", "encoded", "air", "skill", "name"}) fields.erase(other);
      json decoded = fields;
      if (fields.contains("skill_in") && fields.at("skill_in").empty()) {
        fields.erase("skill_in");
        decoded.erase("skill_in");
      } else if (fields.contains("skill_in")) {
        for (const auto& [key, step] : std::map<std::string, double>{
                 {"kickSpeed", 0.02}, {"dribbleSpeed", 0.125}, {"dribbleForce", 0.25}}) {
          json& value = decoded["skill_in"][key];
          value = std::round(value.get<double>() / step) * step;
        }
      }
      rows.push_back({{{name, fields, decoded}}, row.at(row.contains("udp") ? "udp" : "app")});
    }
  }
  return rows;
}

// What the team's own decoder reads wrong; see the page of erforce-proto2025.
inline nlohmann::json without_phi_jerk(nlohmann::json decoded) {
  if (decoded.at("trajectory").is_object()) decoded["trajectory"].erase("phi_jerk");
  return decoded;
}

// COBS of up to 253 bytes, then 00.
inline std::string stuffed(const Bytes& bytes) {
  Bytes frame{0};
  std::size_t code_at = 0;
  for (const std::uint8_t byte : bytes) {
    if (byte != 0) {
      frame.push_back(byte);
      continue;
    }
    frame[code_at] = static_cast<std::uint8_t>(frame.size() - code_at);
    code_at = frame.size();
    frame.push_back(0);
  }
  frame[code_at] = static_cast<std::uint8_t>(frame.size() - code_at);
  frame.push_back(0);
  return to_hex(frame);
}

inline std::vector<TeamRow> erforce_rows(const std::function<nlohmann::json(const char*)>& file,
                                         bool bridged) {
  using nlohmann::json;
  std::vector<TeamRow> rows;
  const json all = file("erforce-proto2025.json");
  std::map<std::string, json> wire;  // of their serial tools, by payload
  for (const json& row : all.at(bridged ? "serial_bridge" : "serial_direct").at("frames")) {
    wire[row.at("packet").get<std::string>().substr(2)] = row;
  }
  std::size_t wired = 0;
  // With the header of their frame, where there is one.
  const auto add = [&](const std::string& name, json given, json decoded, std::string header,
                       const std::string& payload) {
    const auto known = wire.find(payload);
    if (known != wire.end()) header = known->second.at("packet").get<std::string>().substr(0, 2);
    const unsigned head = static_cast<unsigned>(std::stoi(header, nullptr, 16));
    for (json* fields : {&given, &decoded}) {
      (*fields)["counter"] = head & 63u;
      (*fields)["acknum"] = head >> 6 & 1u;
    }
    Bytes bytes = from_hex((bridged ? "00" : "") + header + payload);
    std::uint8_t sum = 0;
    for (const std::uint8_t byte : bytes) sum ^= byte;
    bytes.push_back(sum);
    rows.push_back({{{name, given, decoded}}, stuffed(bytes)});
    if (known == wire.end()) return;
    EXPECT_EQ(rows.back().hex, known->second.at("wire"));
    ++wired;
  };
  for (const json& row : all.at("commands")) {
    json given = row.at("in"), decoded = without_phi_jerk(row.at("decoded"));
    const std::string name = given.at("trajectory_type");
    for (json* fields : {&given, &decoded}) {
      fields->erase("trajectory_type");
      if (fields->at("trajectory").is_null()) fields->erase("trajectory");
    }
    add(name, given, decoded, "00", row.at("payload"));
  }
  for (const json& row : all.at("responses")) {
    add("response", row.at("in"), row.at("decoded"), "00", row.at("payload"));
  }
  EXPECT_EQ(wired, wire.size());
  for (const json& row : all.at("datagrams")) {
    json data = json::array();
    for (const std::uint8_t byte : from_hex(row.at("data"))) data.push_back(byte);
    const json fields{{"seqnum", row.at("seqnum")}, {"data", data}};
    add(row.at("type"), fields, fields, "80", row.at("payload"));
  }
  for (const json& row : all.at("headers")) {
    EXPECT_EQ(row.at("datagram"), false);
    add("halt", json::object(), json::object(), row.at("hex"), std::string(56, '0'));
    EXPECT_EQ(rows.back().packets[0].given.at("counter"), row.at("counter"));
    EXPECT_EQ(rows.back().packets[0].given.at("acknum"), row.at("acknum"));
  }
  if (bridged) {
    rows.push_back({{{"robot_id_request", json::object(), json::object()}},
                    all.at("serial_bridge").at("robot_id_request")});
  }
  return rows;
}

// What their host makes of a command before its fields: which of its numbers go where, and their differences.
inline nlohmann::json erforce_usb_given(const nlohmann::json& row, bool pasta) {
  using nlohmann::json;
  const json& wanted = row.at("command");
  const bool chip = wanted.at("kick_style") == "Chip";
  const float top_m_s = chip ? 5.0F : 10.0F;
  const auto power =
      std::trunc(std::clamp(wanted.at("kick_power").get<float>() * 255.0F / top_m_s, 0.0F, 255.0F));
  json given{{"address_id", row.at("id")},   {"id", row.at("id")},
             {"expected_response_size", 11}, {"counter", row.at("counter")},
             {"charge", row.at("charge")},   {"ir_param", std::min(row.at("ir_param").get<int>(), 63)},
             {"chip", chip ? 1 : 0},         {"shot_power", power}};
  for (const char* same : {"standby", "force_kick", "eject_sdcard", "dribbler"})
    given[same] = wanted.at(same);
  const std::array<const char*, 3> names{pasta ? "v_x" : "v_s", pasta ? "v_y" : "v_f", "omega"};
  for (std::size_t i = 0; i < 3; ++i) {
    given[names[i]] = wanted.at("output0").at(names[i]);
    // The second difference of the yaw rate is to what the first one's count makes of it; of speeds, to the output.
    constexpr double kStep_rad_s = 0.005;
    const auto of = [&](const char* output) { return wanted.at(output).at(names[i]).get<double>(); };
    const double now = of("output0");
    const double first = of("output1") - now;
    const double counts = std::clamp(std::trunc(first / kStep_rad_s), -127.0, 127.0);
    const double next = i < 2 ? of("output1") : now + counts * kStep_rad_s;
    given["delta1"].push_back(first);
    given["delta2"].push_back(of("output2") - next);
  }
  const char* last = pasta ? "cur_phi" : "cur_omega";
  for (const char* now : {"cur_v_s", "cur_v_f", last}) given[now] = wanted.value(now, json());
  return given;
}

inline std::vector<TeamRow> erforce_usb_rows(const std::function<nlohmann::json(const char*)>& file) {
  using nlohmann::json;
  std::vector<TeamRow> rows;
  const json all = file("erforce-usb-pasta-2014.json");
  const auto offset = [](const json& row) {
    return 469 + std::min(row.at("processing_delay_ns").get<int>() / 1000, 2000);
  };
  for (const bool pasta : {true, false}) {
    const std::string name = pasta ? "pasta_command" : "gen2014_command";
    for (const json& row : all.at(name + "s")) {
      json given = erforce_usb_given(row, pasta);
      if (pasta) given["time_offset"] = offset(row);
      // Their host has no decoder of commands: what is whole must come back.
      json decoded;
      for (const auto& [key, value] : given.items()) {
        if (value.is_number_integer() && key != "omega" && !key.starts_with("v_") && key != "dribbler")
          decoded[key] = value;
      }
      rows.push_back({{{name, given, decoded}}, row.at("usb")});
    }
  }
  for (const json& row : all.at("gen2014_sync")) {
    const json fields{
        {"counter", row.at("counter")}, {"time_offset", offset(row)}, {"expected_response_size", 1}};
    rows.push_back({{{"gen2014_sync", fields, fields}}, row.at("usb")});
  }
  for (const json& row : all.at("ping")) {
    const json fields{{"time", row.at("time")}};
    rows.push_back({{{"ping", fields, fields}}, row.at("usb")});
  }
  constexpr const char* kErrors[] = {
      "error_motor_1", "error_motor_2",    "error_motor_3", "error_motor_4",     "error_dribbler",
      "error_kicker",  "error_break_beam", "error_encoder", "error_main_sensor", "temperature"};
  for (const json& row : all.at("responses")) {
    const Bytes raw = from_hex(row.at("raw"));
    const bool errors = row.at("extension_id") == 1;
    json fields{{"generation", raw[0]}, {"counter", row.at("counter")}, {"id", row.at("id")}};
    for (const char* flag : {"power_enabled", "error_present", "ball_detected", "cap_charged"}) {
      // Without power their decoder leaves the rest out: from the bits then.
      const unsigned bit = flag[0] == 'p' ? 4 : flag[0] == 'e' ? 5 : flag[0] == 'b' ? 6 : 7;
      fields[flag] = raw[2] >> bit & 1u;
      EXPECT_EQ(row.value(flag, fields[flag]), fields[flag]);
    }
    for (const char* speed : {"v_s", "v_f", "omega"}) {
      const auto count = row.at(std::string("raw_") + speed).get<float>();
      fields[speed] = count / 1000.0F;
      EXPECT_EQ(row.value(speed, count / 1000.0F), count / 1000.0F);
    }
    if (errors) {
      for (std::size_t i = 0; i < std::size(kErrors); ++i)
        fields[kErrors[i]] = row.at("extended_error").at(i);
    } else {
      fields["battery"] = row.at("battery");
      fields["packet_loss_rx"] = row.at("packet_loss_rx");
    }
    rows.push_back({{{errors ? "response_errors" : "response", fields, fields}},
                    "0b90" + row.at("raw").get<std::string>()});
  }
  return rows;
}

inline const std::vector<TeamFile>& team_files() {
  static const std::vector<TeamFile> files{
      {"ibis-robot-command-v2", 24 + 24 + 15, ibis_rows},
      {"ateam-rnp-stspin-2025", 155, ateam_rows},
      {"rhoban-master-serial", 20 + 16, rhoban_rows},
      {"rocos-serial-25", 8 + 8 + 20, rocos_rows},
      {"tigers-base-station", 16 + 12 + 10 + 3, tigers_rows},
      {"erforce-proto2025", 30 + 20 + 5 + 10, [](const auto& file) { return erforce_rows(file, false); }},
      {"erforce-proto2025-bridge", 30 + 20 + 5 + 10 + 1,
       [](const auto& file) { return erforce_rows(file, true); }},
      {"ibis-uart72", 12, ibis_uart_rows},
      {"ibis-broadcast-715", 23 + 23, ibis_broadcast_rows},
      {"erforce-usb-pasta-2014", 20 + 15 + 3 + 4 + 20, erforce_usb_rows},
  };
  return files;
}

inline std::vector<TeamRow> team_rows(const TeamFile& of) {
  return of.load([](const char* name) { return read_json(shared_folder() + "/vectors/" + name); });
}

}  // namespace omnihil
