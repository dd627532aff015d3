// Rows that the versions of RoboTeam Twente's REM have in common.
#pragma once
#include <array>
#include <numbers>

#include "protocols/field_rows.h"

namespace omnihil::rem {

inline constexpr double kPi = std::numbers::pi;

// The header of every packet but SX1280Filler. `type_name` and the timestamp differ between versions.
constexpr auto header_rows(std::string_view type_name, std::uint64_t version, int timestamp_bits,
                           std::string_view timestamp_unit, std::string_view timestamp_what) {
  return std::array{
      type_code(type_name, 8),
      with_role(FieldRole::kRobot, number("toRobotId", 4, "", "receiving robot")),
      with_role(FieldRole::kTeam, flag("toColor", "team of the receiver: 0 yellow, 1 blue")),
      with_role(FieldRole::kAllRobots, flag("toBC", "for all robots")),
      with_role(FieldRole::kForDongle, flag("toBS", "for the base station")),
      with_role(FieldRole::kForHost, flag("toPC", "for the host")),
      number("fromRobotId", 4, "", "sending robot"),
      flag("fromColor", "team of the sender: 0 yellow, 1 blue"),
      reserved("reserved", 1, "not used"),
      flag("fromBS", "sent by the base station"),
      flag("fromPC", "sent by the host"),
      omnihil::version(
          constant("remVersion", 4, version, "version of the packet tables; another version is dropped")),
      number("messageId", 4, "", "counter of the sender, modulo 16"),
      number("timestamp", timestamp_bits, timestamp_unit, timestamp_what),
      length("payloadSize", 8, "length of the whole packet, header and text included"),
  };
}

inline constexpr std::array kBuzzerRows{
    number("period", 12, "", "period of the buzzer's tone"),
    ranged("duration", 16, 0.0, 5.0, "s", "how long it sounds"),
    padding(4),
};
inline constexpr std::array kBasestationConfigurationRows{
    flag("channel", "radio channel: 0 yellow, 1 blue"),
    padding(7),
};
inline constexpr std::array kAssuredPacketRows{
    number("sequenceNumber", 8, "", "the acknowledgement repeats it"),
    number("messageLength", 8, "bytes", "length of the packet that follows"),
};
inline constexpr std::array kAssuredAckRows{
    number("sequenceNumber", 8, "", "that of the packet acknowledged"),
};
inline constexpr std::array kMusicRows{
    flag("play", "play the song"),
    flag("pause", "pause the song"),
    flag("stop", "stop the song"),
    flag("previousSong", "go back one song"),
    flag("nextSong", "go on to the next song"),
    number("volume", 5, "", "1 to 31; 0 leaves it as it is"),
    flag("volumeUp", "louder by one"),
    flag("volumeDown", "softer by one"),
    number("folderId", 4, "", "folder of the song"),
    number("songId", 8, "", "song in the folder"),
};
constexpr auto filler_rows(std::uint64_t version) {
  return std::array{
      type_code("header", 8),
      omnihil::version(constant("remVersion", 4, version, "version of the packet tables")),
      reserved("fillerBits", 36, "any content"),
  };
}
inline constexpr std::array kBallSensorRows{
    flag("ballSensorWorking", "the ball sensor works"),
    flag("ballSensorSeesBall", "the ball sensor sees the ball"),
};

constexpr Message packet(std::string_view name, std::uint32_t type, int size_bytes, Direction direction,
                         std::span<const Field> fields, std::string_view what,
                         MessageRole role = MessageRole::kNone) {
  return {name, type, size_bytes, false, direction, BitOrder::kMsbFirst, fields, what, role};
}
constexpr Message with_text(Message message) {
  message.text_tail = true;
  return message;
}

inline constexpr std::string_view kWhatPacket = "Header alone.";
inline constexpr std::string_view kWhatCommand = "Body velocity in polar form, heading, kick and dribble.";
inline constexpr std::string_view kWhatFeedback = "The robot's answer to each command.";
inline constexpr std::string_view kWhatStateInfo = "Sensors and the inside of the controllers.";
inline constexpr std::string_view kWhatBuzzer = "Sound the buzzer.";
inline constexpr std::string_view kWhatLog = "A line of text for the host, from a robot or the base station.";
inline constexpr std::string_view kWhatGetConfiguration = "Ask the base station for its configuration.";
inline constexpr std::string_view kWhatConfiguration =
    "Configuration of the base station: its answer, or the host's order.";
inline constexpr std::string_view kWhatGetGains = "Ask a robot for its gains. Answered by REM_RobotPIDGains.";
inline constexpr std::string_view kWhatGains = "The gains a robot uses.";
inline constexpr std::string_view kWhatSetGains = "Set a robot's gains.";
inline constexpr std::string_view kWhatAssured = "Announces a packet that must be acknowledged.";
inline constexpr std::string_view kWhatAck = "Acknowledges a packet that was announced.";
inline constexpr std::string_view kWhatMusic = "Music player on the robot.";
inline constexpr std::string_view kWhatFiller =
    "Fills an air packet up to the radio's least length; never on USB.";
inline constexpr std::string_view kWhatKill = "The robot switches itself off.";

inline constexpr std::string_view kCommonNotes =
    "- No framing and no checksum on USB: the type gives the length, payloadSize repeats it, packets follow "
    "each "
    "other without a gap. After one bad packet the base station drops everything it has buffered. A changed "
    "bit "
    "changes exactly the field that owns it, unless that is type, version or payloadSize.\n"
    "- All fields are MSB-first in the order of the table, integers big-endian.\n"
    "- Ranged fields, all in float32: scale = (max - min) / (2^bits - 1), printed with 16 decimals and read "
    "back; "
    "raw = trunc((value - min) / scale); value = raw * scale + min. So 0 rad becomes raw 7FFFh and comes "
    "back as "
    "-4.79e-5 rad, and a value that was decoded and is encoded again may come out one count lower.\n"
    "- `xsensYaw` at its largest value of +50000 wraps to raw 0, which reads as -50000: float32 cannot hold "
    "2^32 - 1 counts.\n";

}  // namespace omnihil::rem
