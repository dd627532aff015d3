#include "hil/firmware/board_ports.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "firmware_iface/mcu/board/can_frames.h"
#include "firmware_iface/mcu/stm32/can.h"
#include "firmware_iface/mcu/stm32/serial_port.h"
#include "hil/firmware/console_text.h"
#include "hil/firmware/rtt_console.h"
#include "hil/wire/buffered_wire.h"
#include "hil/wire/open_wire.h"

namespace omnihil {
namespace {

constexpr std::size_t kQueueBytes = 65'536;  // what a slow reader may leave waiting

WireForm form_of(const mcu::PortEntry& port) {
  return port.source == mcu::PortSource::kCan ? WireForm::kFrames : WireForm::kBytes;
}

WireUrl url_of(const mcu::PortEntry& port, const BoardPortsOptions& options) {
  const std::string text = with_number(with_number(port.as, "{id}", options.robot_id), "{board}",
                                       static_cast<std::uint32_t>(options.board));
  return read_wire_url(text, "pty");
}

mcu::BoardProblem problem_of(const mcu::PortEntry& port, const std::string& file, std::string what,
                             std::string allowed) {
  return {file, port.line, port.key + ".as", port.as, std::move(what), std::move(allowed)};
}

std::string_view as_text(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// The others come to us.
const WireQuery kUsual = {{"listen", "1"}};

std::unique_ptr<BufferedWire> byte_wire(const mcu::PortEntry& entry, const BoardPortsOptions& options,
                                        WireProblem& problem) {
  if (entry.as.empty()) return nullptr;
  std::unique_ptr<ByteWire> wire = open_byte_wire(url_of(entry, options), kUsual, problem);
  return wire ? std::make_unique<BufferedWire>(std::move(wire), kQueueBytes) : nullptr;
}

}  // namespace

struct BoardPorts::Port {
  explicit Port(const mcu::PortEntry& entry) : is(entry) {}
  virtual ~Port() = default;
  virtual void pump() {}
  virtual void add_report(std::vector<std::string>& lines) const = 0;
  mcu::PortEntry is;
};

// A byte wire and what passes it.
struct BoardPorts::WireEnd {
  bool open() const { return wire && !wire->error(); }
  // What has come, at most so much: what is more waits where it is.
  std::span<const std::uint8_t> take(std::size_t most) {
    arrived.clear();
    wire->read(arrived, most);
    in += arrived.size();
    return arrived;
  }
  void send() {
    static_cast<void>(wire->take_peer_closed());
    wire->flush();
    if (!sent.empty() && (!wire->peer_present() || !wire->write(sent))) lost += sent.size();
    sent.clear();
  }
  void say(std::span<const std::uint8_t> bytes) {
    out += bytes.size();
    if (wire) sent.insert(sent.end(), bytes.begin(), bytes.end());
  }
  void add_report(std::vector<std::string>& lines, const mcu::PortEntry& is) const {
    if (!wire) return;
    lines.push_back(fmt::format("{} at {}: {} bytes out{}, {} in{}{}", is.of, wire->name(), out,
                                lost > 0 ? fmt::format(" ({} that nobody took)", lost) : "", in,
                                wire->failure().empty() ? "" : "; ", wire->failure()));
  }

  std::unique_ptr<BufferedWire> wire;  // null: none
  std::vector<std::uint8_t> sent, arrived;
  std::uint64_t out = 0, in = 0, lost = 0;
};

// What is typed at a port's console, from the first of it that it was not given yet.
struct BoardPorts::Typed {
  Typed(const mcu::PortEntry& entry, const BoardPortsOptions& options)
      : text(entry.console ? options.typed : ConsoleInput{}), robot_id(options.robot_id) {}
  std::span<const std::uint8_t> take(std::size_t most) {
    if (!text) return {};
    const std::string_view more = text(robot_id).substr(given).substr(0, most);
    given += more.size();
    return {reinterpret_cast<const std::uint8_t*>(more.data()), more.size()};
  }
  ConsoleInput text;
  std::uint32_t robot_id;
  std::size_t given = 0;
};

struct BoardPorts::SerialPort final : Port {
  SerialPort(const mcu::PortEntry& entry, mcu::McuBoard& on, ConsoleText console,
             const BoardPortsOptions& options)
      : Port(entry),
        board(on),
        usart(*on.chip().find<mcu::SerialPort>(entry.of)),
        text(std::move(console)),
        typed(entry, options) {
    usart.on_transmit([this](std::uint8_t byte, mcu::Cycles) {
      if (is.console) text.add(as_text({&byte, 1}));
      end.say({&byte, 1});
    });
  }

  void pump() override {
    // Not more than the line carries in that time.
    const double per_run = usart.baud() / 10.0 * 1e-9 * static_cast<double>(board.spec().coupling_ns);
    const auto most = static_cast<std::size_t>(std::clamp(per_run, 1.0, 4096.0));
    const auto by_hand = typed.take(most);
    if (!by_hand.empty()) usart.feed(by_hand, board.now_ns());
    if (!end.open()) return;
    const auto arrived = end.take(most - by_hand.size());
    if (!arrived.empty()) usart.feed(arrived, board.now_ns());
    end.send();
  }

  void add_report(std::vector<std::string>& lines) const override {
    end.add_report(lines, is);
    add_text(lines, is, text);
  }

  static void add_text(std::vector<std::string>& lines, const mcu::PortEntry& is, const ConsoleText& text) {
    if (!is.console || text.count() == 0) return;
    const std::vector<std::string> kept = text.lines();
    lines.push_back(fmt::format("{} said {} lines{}:", is.of, text.count(),
                                text.count() > kept.size() ? fmt::format(", the last {}", kept.size()) : ""));
    for (const std::string& line : kept) lines.push_back(fmt::format("{} | {}", is.of, line));
  }

  mcu::McuBoard& board;
  mcu::SerialPort& usart;
  ConsoleText text;
  Typed typed;
  WireEnd end;
};

struct BoardPorts::CanLine final : Port {
  CanLine(const mcu::PortEntry& entry, mcu::McuBoard& board, std::unique_ptr<FrameWire> to)
      : Port(entry), can(*board.chip().find<mcu::CanPort>(entry.of)), wire(std::move(to)) {
    can.on_transmit([this](const mcu::CanFrame& frame, mcu::Cycles) {
      ++out;
      if (wire->error() || !wire->write(mcu::bus_frame_of(frame))) ++lost;
    });
  }

  void pump() override {
    BusFrame frame;
    for (int i = 0; i < kFramesAtOnce && !wire->error() && wire->read(frame); ++i) {
      ++in;
      can.receive(mcu::can_frame_of(frame));
    }
  }

  void add_report(std::vector<std::string>& lines) const override {
    lines.push_back(fmt::format("{} at {}: {} frames out{}, {} in{}", is.of, wire->name(), out,
                                lost > 0 ? fmt::format(" ({} that nobody took)", lost) : "", in,
                                wire->error() ? "; " + wire->error().message() : ""));
    for (const std::string& line : wire->report()) lines.push_back(line);
  }

  mcu::CanPort& can;
  std::unique_ptr<FrameWire> wire;
  std::uint64_t out = 0, in = 0, lost = 0;
};

struct BoardPorts::TextSource final : Port {
  TextSource(const mcu::PortEntry& entry, mcu::McuBoard& board, ConsoleText console)
      : Port(entry), text(std::move(console)) {
    const auto listener = [this](std::string_view said) { text.add(said); };
    if (entry.source == mcu::PortSource::kItm) {
      board.machine().set_trace_listener(listener);
    } else {
      board.machine().set_semihosting(listener);
    }
  }
  void add_report(std::vector<std::string>& lines) const override { SerialPort::add_text(lines, is, text); }
  ConsoleText text;
};

struct BoardPorts::RttSource final : Port {
  RttSource(const mcu::PortEntry& entry, mcu::McuBoard& board, ConsoleText console,
            const BoardPortsOptions& options)
      : Port(entry), rtt(board.machine()), text(std::move(console)), typed(entry, options) {}
  void pump() override {
    rtt.pump([this](std::string_view said) {
      if (is.console) text.add(said);
      end.say({reinterpret_cast<const std::uint8_t*>(said.data()), said.size()});
    });
    if (const std::size_t room = rtt.room(); room > 0) {
      if (const auto by_hand = typed.take(room); !by_hand.empty()) rtt.put(by_hand);
    }
    if (!end.open()) return;
    if (const std::size_t room = rtt.room(); room > 0) rtt.put(end.take(room));
    end.send();
  }
  void add_report(std::vector<std::string>& lines) const override {
    if (!rtt.found()) lines.push_back("RTT: no control block is in RAM");
    end.add_report(lines, is);
    SerialPort::add_text(lines, is, text);
  }
  RttConsole rtt;
  ConsoleText text;
  Typed typed;
  WireEnd end;
};

struct BoardPorts::BusLine final : Port {
  BusLine(const mcu::PortEntry& entry, mcu::McuBoard& board, BoardBuses& of)
      : Port(entry),
        buses(of),
        counts(buses.join(entry.bus, board, *board.chip().find<mcu::CanPort>(entry.of))) {}
  void add_report(std::vector<std::string>& lines) const override {
    lines.push_back(fmt::format("{} on bus {} of {} boards: {} frames out, {} in", is.of, is.bus,
                                buses.ends_of(is.bus), counts->out, counts->in));
  }
  BoardBuses& buses;
  std::shared_ptr<const BoardBuses::Counts> counts;
};

std::vector<mcu::BoardProblem> port_problems(const mcu::BoardSpec& spec, const std::string& board_file) {
  std::vector<mcu::BoardProblem> problems;
  for (const mcu::PortEntry& port : spec.ports) {
    if (port.as.empty()) continue;
    for (const std::string& why : wire_problems(url_of(port, {}), form_of(port)))
      problems.push_back(problem_of(port, board_file, why, known_wires(form_of(port))));
  }
  return problems;
}

BoardPorts::BoardPorts(mcu::McuBoard& board, const BoardPortsOptions& options) {
  for (const mcu::PortEntry& entry : board.spec().ports) {
    ConsoleText text([on_line = options.on_line, id = options.robot_id, number = options.board,
                      of = entry.of](const std::string& line) {
      if (on_line) on_line(id, number, of, line);
    });
    WireProblem problem;
    if (entry.source == mcu::PortSource::kRtt) {
      auto port = std::make_unique<RttSource>(entry, board, std::move(text), options);
      port->end.wire = byte_wire(entry, options, problem);
      ports_.push_back(std::move(port));
    } else if (!entry.bus.empty()) {
      ports_.push_back(std::make_unique<BusLine>(entry, board, *options.buses));
    } else if (entry.source == mcu::PortSource::kSemihosting || entry.source == mcu::PortSource::kItm) {
      ports_.push_back(std::make_unique<TextSource>(entry, board, std::move(text)));
    } else if (entry.source == mcu::PortSource::kCan) {
      std::unique_ptr<FrameWire> wire = open_frame_wire(url_of(entry, options), kUsual, problem);
      if (wire) ports_.push_back(std::make_unique<CanLine>(entry, board, std::move(wire)));
    } else {
      auto port = std::make_unique<SerialPort>(entry, board, std::move(text), options);
      port->end.wire = byte_wire(entry, options, problem);
      ports_.push_back(std::move(port));
    }
    if (!problem.what.empty()) {
      const std::string hint = entry.as.find("{id}") == std::string::npos
                                   ? "a place of its own for each robot: {id} is its number"
                                   : "";
      throw std::invalid_argument(problem_of(entry, options.board_file, problem.text(), hint).text());
    }
  }
}

BoardPorts::~BoardPorts() = default;

void BoardPorts::pump() {
  for (const auto& port : ports_) port->pump();
}

std::vector<std::string> BoardPorts::report() const {
  std::vector<std::string> lines;
  for (const auto& port : ports_) port->add_report(lines);
  return lines;
}

}  // namespace omnihil
