// What passes between the bench and the process that holds a team's firmware: one datagram per call over a
// socket pair (SOCK_SEQPACKET), answers where a call has one, and one shared page that outlives a crash.
//
//   bench                                   firmware process
//   Request{kLoad} + path         ──►       LoadReply, or text of what is wrong
//   Request{kInit} + StartInput   ──►       int32 code, then TickReply of the state before the first tick
//   Request{kCommand} + …         ──►       (no answer: it is dealt with before the next tick)
//   Request{kTick} + RobotSensors ──►       TickReply: drive, feedback, gains and the frames to send
//   Request{kPeek} + MemoryPiece… ──►       one byte 1 and the pieces' bytes; or one byte 0
//   Request{kPoke} + MemoryPiece, bytes ──► one byte: 1 done, 0 not there
//
// Lock-step: the bench waits for the answer of a tick, so the result does not depend on how long it took.
// Both sides are of one build; the numbers pass as they are in memory.
#pragma once
#include <cstdint>
#include <type_traits>

#include "firmware_iface/robot_io.h"

namespace omnihil {

enum class FirmwareCall : std::uint32_t {
  kLoad,
  kInit,
  kMotorInit,
  kCommand,
  kRadioReceive,
  kRadioTransmit,
  kSetGains,
  kGetGains,
  kTick,
  kFeedback,
  kMotorTick,
  kPeek,
  kPoke,
};
inline constexpr const char* kFirmwareCallNames[] = {
    "loading the library", "init()",          "motor_init()",
    "command()",           "radio_receive()", "radio_transmit()",
    "set_gains()",         "get_gains()",     "tick()",
    "feedback()",          "motor_tick()",    "reading variables",
    "setting a variable"};

inline constexpr std::size_t kWireFrameBytes = 512;  // of a frame that a firmware sends
inline constexpr int kWireFrames = 16;               // per tick
inline constexpr std::size_t kWireTextBytes = 4096;

struct WireRequest {
  FirmwareCall call = FirmwareCall::kLoad;
  std::uint32_t count = 0;  // bytes of what follows
  std::int64_t now_ns = 0;
};

struct WireStart {
  RobotConfig config{};
  MotorConfig motors{};
  std::uint32_t has_motors = 0;
  std::uint32_t reserved = 0;
};

struct WireLoaded {
  std::uint32_t problem_bytes = 0;  // of `text`: why it cannot be used; 0: it can
  std::uint32_t control_period_us = 0;
  std::uint32_t has_motor_tick = 0;
  std::uint64_t state_bytes = 0;
  std::uint32_t name_bytes = 0, radio_bytes = 0;  // of `text`
  char text[kWireTextBytes];                      // problems; or name, then radio format
};

struct WireFrame {
  std::uint32_t bytes = 0;
  std::uint8_t data[kWireFrameBytes];
};

// The first `frames` of `frame` are sent, no more.
struct WireTick {
  RobotDrive drive{};
  RobotFeedback feedback{};
  RobotGains gains{};
  std::int32_t code = 0;             // init, motor_init, set_gains
  std::uint32_t frames_refused = 0;  // longer than they may be
  std::uint32_t frames = 0;
  WireFrame frame[kWireFrames];
};

// How a process that is no more ended. Written by it, read by the bench.
enum class CrashKind : std::uint32_t { kNone, kState, kStack, kNull, kElsewhere };
struct WirePage {
  FirmwareCall call = FirmwareCall::kLoad;  // in progress, or the last one
  std::uint32_t in_firmware = 0;            // 1: inside it, 0: between calls
  std::uint64_t ticks = 0;                  // begun
  std::int64_t now_ns = 0;                  // of the last call that said
  CrashKind crash = CrashKind::kNone;       // of a memory fault
  std::int64_t offset_bytes = 0;            // kState: from the state's begin; kNull: the address
  std::int64_t state_bytes = 0;
};

static_assert(std::is_trivially_copyable_v<WireTick> && std::is_trivially_copyable_v<WireStart>);

}  // namespace omnihil
