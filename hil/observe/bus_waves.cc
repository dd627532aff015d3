#include "hil/observe/bus_waves.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "firmware_iface/mcu/stm32/can.h"
#include "firmware_iface/mcu/stm32/serial_port.h"
#include "firmware_iface/mcu/stm32/spi.h"

namespace omnihil {
namespace {

constexpr WaveValue kHigh{1, false};

// One line of a serial port.
struct SerialLine {
  int levels = -1, byte = -1;
  std::int64_t free_ns = 0;  // the last frame is over
};

std::int64_t ns_of(const mcu::McuBoard& board, double cycles) {
  return std::llround(cycles * 1e9 / board.machine().core_hz());
}

void watch_serial(mcu::McuBoard& board, mcu::SerialPort& port, const std::string& of, WaveLog& log,
                  const std::string& scope) {
  struct Lines {
    SerialLine of[2];
  };
  auto lines = std::make_shared<Lines>();
  constexpr const char* kNames[] = {"_RX", "_TX"};
  for (int sent = 0; sent < 2; ++sent) {
    const std::string name = of + kNames[sent];
    lines->of[sent] = {log.add(scope, name, WaveKind::kLevel, 1, kHigh),
                       log.add(scope, name + "_byte", WaveKind::kWord, 8)};
  }
  port.watch_frames([&board, &log, lines](const mcu::SerialFrame& frame) {
    SerialLine& line = lines->of[frame.sent ? 1 : 0];
    const auto bit = static_cast<double>(frame.bit);
    const std::int64_t end_ns = board.machine().to_ns(frame.end);
    const std::int64_t begin_ns = std::max(line.free_ns, end_ns - ns_of(board, bit * frame.bits));
    for (unsigned i = 0; i < frame.bits; ++i)
      log.put(line.levels, std::min(begin_ns + ns_of(board, bit * i), end_ns), frame.levels >> i & 1u);
    log.put(line.byte, begin_ns, frame.byte);
    log.put_none(line.byte, end_ns);
    line.free_ns = end_ns;
  });
}

void watch_spi(mcu::McuBoard& board, mcu::Spi& spi, WaveLog& log, const std::string& scope) {
  struct Lines {
    int clock, out, in;
  };
  const Lines lines{log.add(scope, spi.name() + "_SCK", WaveKind::kLevel),
                    log.add(scope, spi.name() + "_MOSI", WaveKind::kLevel),
                    log.add(scope, spi.name() + "_MISO", WaveKind::kLevel)};
  spi.watch_frames([&board, &log, lines](const mcu::SpiFrame& frame) {
    const double half = static_cast<double>(frame.end - frame.begin) / (2.0 * frame.bits);
    const std::int64_t begin_ns = board.machine().to_ns(frame.begin);
    const auto edge_ns = [&](unsigned halves) { return begin_ns + ns_of(board, half * halves); };
    const std::uint64_t rest = frame.idle_high ? 1 : 0;
    log.put(lines.clock, begin_ns, rest);
    for (unsigned i = 0; i < frame.bits; ++i) {
      const unsigned place = frame.bits - 1 - i;
      log.put(lines.out, edge_ns(2 * i), frame.out >> place & 1u);
      log.put(lines.in, edge_ns(2 * i), frame.in >> place & 1u);
      // The sampling edge stands in the middle of the bit, the first one of the pair or the second.
      log.put(lines.clock, edge_ns(2 * i), frame.second_edge ? 1 - rest : rest);
      log.put(lines.clock, edge_ns(2 * i + 1), frame.second_edge ? rest : 1 - rest);
    }
    log.put(lines.clock, board.machine().to_ns(frame.end), rest);
  });
}

void watch_can(mcu::McuBoard& board, mcu::CanPort& can, const std::string& name, WaveLog& log,
               const std::string& scope) {
  struct Wire {
    int levels, id, data;
    std::int64_t free_ns = 0;
  };
  auto wire = std::make_shared<Wire>(Wire{log.add(scope, name, WaveKind::kLevel, 1, kHigh),
                                          log.add(scope, name + "_id", WaveKind::kWord, 29),
                                          log.add(scope, name + "_data", WaveKind::kWord, 64)});
  can.watch_frames([&board, &log, wire](const mcu::CanPass& pass) {
    constexpr unsigned kPause = 3;  // bits of the interframe space, which a frame that comes has not had yet
    const mcu::CanFrame& frame = pass.frame;
    const std::vector<bool> bits = frame.fd ? std::vector<bool>{} : can_line_bits(frame);
    const unsigned count = frame.fd ? mcu::can_frame_bits(frame) : static_cast<unsigned>(bits.size());
    const double before_end = pass.bit * (pass.sent ? count : count - kPause);
    const std::int64_t begin_ns =
        std::max(wire->free_ns, board.machine().to_ns(pass.end) - ns_of(board, before_end));
    for (std::size_t i = 0; i < bits.size(); ++i)
      log.put(wire->levels, begin_ns + ns_of(board, pass.bit * static_cast<double>(i)), bits[i] ? 1 : 0);
    const std::int64_t end_ns = begin_ns + ns_of(board, pass.bit * (count - kPause));
    std::uint64_t data = 0;
    const unsigned shown = frame.remote ? 0u : std::min<unsigned>(frame.bytes, 8);
    for (unsigned i = 0; i < shown; ++i) data = data << 8 | frame.data[i];
    log.put(wire->id, begin_ns, frame.id);
    if (shown > 0) log.put(wire->data, begin_ns, data);
    log.put_none(wire->id, end_ns);
    log.put_none(wire->data, end_ns);
    wire->free_ns = begin_ns + ns_of(board, pass.bit * count);
  });
}

}  // namespace

void watch_buses(mcu::McuBoard& board, WaveLog& log, const std::string& scope) {
  for (const mcu::Chip::Mapped& block : board.chip().blocks()) {
    if (auto* port = dynamic_cast<mcu::SerialPort*>(block.peripheral))
      watch_serial(board, *port, block.peripheral->name(), log, scope);
    if (auto* spi = dynamic_cast<mcu::Spi*>(block.peripheral)) watch_spi(board, *spi, log, scope);
    if (auto* can = dynamic_cast<mcu::CanPort*>(block.peripheral))
      watch_can(board, *can, block.peripheral->name(), log, scope);
  }
}

}  // namespace omnihil
