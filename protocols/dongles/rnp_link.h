// SSL A-Team's robots on the network: discovery, handshake and time-outs of a robot that a host reaches by UDP.
//
//   no host   hello_request every second until a hello_response comes, or a refusal
//   host      control -> command; telemetry 100 times a second; parameters are answered
//   silence   0.2 s without control: the wheels stop; 1 s without a packet: the robot starts anew
//
// Nothing names the robot behind the handshake: one wire is one robot. Behaviour and sources: docs/dongles.md.
#pragma once
#include "protocols/dongles/sized_stream.h"
#include "protocols/radio_format.h"

namespace omnihil {

// What a version of the packets says in its own fields.
struct RnpDialect {
  std::optional<std::size_t> (*frame_bytes)(std::span<const std::uint8_t> front) = nullptr;
  void (*hello)(int id, Team team, Values& out) = nullptr;
  RobotCommand (*to_command)(const Values& control) = nullptr;
  // `control` is the latest one; null: none has come.
  void (*telemetry)(const RobotFeedback& feedback, const Values* control, std::uint32_t sequence,
                    Values& out) = nullptr;
  // Answers to a parameter packet; true: it has changed the gains. Null: the version has none.
  bool (*parameter)(const Values& asked, RobotGains& gains, Values& out) = nullptr;
  std::uint32_t hello_answer = 0, control = 0, parameters = 0;  // types of packets
  bool (*turns_away)(const Values& packet) = nullptr;           // a refusal or a goodbye
};

std::unique_ptr<RadioLink> make_rnp_link(const RadioFormat& format, const RadioLinkConfig& config,
                                         const RnpDialect& dialect);

}  // namespace omnihil
