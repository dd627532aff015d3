// HERMES frames written by hand for the tests: header, sum, COBS, 00; independent of both codecs.
#pragma once
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <string>
#include <vector>

namespace omnihil::test {

using Bytes = std::vector<std::uint8_t>;

enum HermesType : std::uint8_t {
  kPing = 0,
  kPingResponse = 1,
  kSpeedMove = 2,
  kSetRegister = 3,
  kOpenLoop = 4,
  kGetBattery = 5,
  kBatteryResponse = 6,
  kGetNum = 7,
  kNumResponse = 8,
  kSpeedMoveAdvance = 9
};

inline Bytes floats(std::initializer_list<float> values) {
  Bytes bytes;
  for (float value : values) {
    std::uint32_t raw;
    std::memcpy(&raw, &value, 4);
    for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<std::uint8_t>(raw >> (8 * i)));
  }
  return bytes;
}

inline Bytes operator+(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// version, source, destination, type, sum of all the others
inline Bytes packet(std::uint8_t source, std::uint8_t destination, std::uint8_t type,
                    const Bytes& payload = {}) {
  Bytes bytes = Bytes{1, source, destination, type, 0} + payload;
  std::uint8_t sum = 0;
  for (std::uint8_t byte : bytes) sum = static_cast<std::uint8_t>(sum + byte);
  bytes[4] = sum;
  return bytes;
}

inline Bytes stuffed(const Bytes& data) {
  Bytes out, block;
  for (std::size_t i = 0; i <= data.size(); ++i) {
    if (i < data.size() && data[i] != 0) {
      block.push_back(data[i]);
      continue;
    }
    out.push_back(static_cast<std::uint8_t>(block.size() + 1));
    out.insert(out.end(), block.begin(), block.end());
    block.clear();
  }
  out.push_back(0);
  return out;
}

inline Bytes to_robot(std::uint8_t robot, std::uint8_t type, const Bytes& payload = {}) {
  return stuffed(packet(0xFE, robot, type, payload));
}
inline Bytes from_robot(std::uint8_t robot, std::uint8_t type, const Bytes& payload = {}) {
  return stuffed(packet(robot, 0x00, type, payload));
}

inline Bytes from_hex(const std::string& hex) {
  Bytes bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(hex.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

}  // namespace omnihil::test
