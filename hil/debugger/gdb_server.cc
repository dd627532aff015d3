#include "hil/debugger/gdb_server.h"

#include <fmt/format.h>

#include <algorithm>

#include "hil/loop/clock.h"
#include "hil/wire/descriptor.h"

namespace omnihil {
namespace {

constexpr std::size_t kBite = 65'536, kQueue = 1u << 20;
constexpr std::int64_t kLookEvery_ns = 50'000'000;  // of wall time, for signals while the bench stands

// Signals as GDB numbers them (include/gdb/signals.def).
constexpr int kSigInt = 2, kSigIll = 4, kSigTrap = 5, kSigSegv = 11;

int signal_of(const mcu::Halt& halt) {
  constexpr std::uint32_t kNoInstruction = mcu::kUndefinedInstruction | mcu::kInvalidState | mcu::kNoCp;
  if (halt.cause == mcu::HaltCause::kAsked) return kSigInt;
  if (halt.cause != mcu::HaltCause::kFault) return kSigTrap;
  return (halt.status & kNoInstruction) != 0 ? kSigIll : kSigSegv;
}

}  // namespace

std::string GdbServer::Board::name() const {
  return is.alone ? fmt::format("robot {}", is.robot) : fmt::format("robot {} board {}", is.robot, is.board);
}

GdbServer::GdbServer(std::unique_ptr<ByteWire> wire, GdbServerOptions options)
    : wire_(std::move(wire), kQueue), options_(std::move(options)), waiting_for_first_(options_.wait) {}

GdbServer::~GdbServer() { end(0); }

void GdbServer::add(const DebuggedBoard& board) {
  if (options_.robot >= 0 && board.robot != options_.robot) return;
  if (options_.board >= 0 && board.board != options_.board) return;
  Board& added = boards_.emplace_back(Board{board, nullptr});
  added.unit = &board.machine->debug(*this);
  if (registers_.empty()) registers_ = gdb_registers(board.machine->cpu().variant());
}

std::string GdbServer::problem() const {
  if (boards_.empty())
    return "no microcontroller image that could be debugged: needs --firmware IMAGE --board FILE, and a "
           "robot that has it";
  for (const Board& board : boards_) {
    if (gdb_registers(board.is.machine->cpu().variant()).size() != registers_.size())
      return fmt::format("{} has another kind of core than {}: GDB debugs them one by one, --gdb-robot",
                         board.name(), boards_.front().name());
  }
  return {};
}

void GdbServer::about_to_run(mcu::DebugUnit& unit) {
  if (ended_) return;
  if (waiting_for_first_) {
    unit.ask();
    return;
  }
  listen();
  while (std::optional<GdbEvent> event = input_.take()) {
    if (event->kind == GdbEventKind::kInterrupt || !attached_) unit.ask();
    if (event->kind != GdbEventKind::kPacket) continue;
    if (!attached_) attach();
    if (command(event->data) == Then::kStay) unit.ask();  // GDB spoke while the bench ran
  }
  keep_moment(unit);
}

// Takes in what has arrived; a client that left is gone before the next one is heard.
void GdbServer::listen() {
  std::vector<std::uint8_t> bytes;
  wire_.read(bytes, kBite);
  input_.add(bytes);
  if (wire_.take_peer_closed() || wire_.error()) detach();
}

void GdbServer::attach() {
  attached_ = acks_ = true;
  for (const Board& board : boards_) board.unit->set_catching(true);
}

void GdbServer::detach() {
  breakpoints_.clear();
  watches_.clear();
  apply();
  for (const Board& board : boards_) board.unit->set_catching(false);
  left_ = !waiting_for_first_ || attached_;
  attached_ = owes_stop_ = stepped_ = false;
  moments_.forget();
  input_.clear();
  wire_.clear();
}

void GdbServer::apply() {
  for (const Board& board : boards_) {
    board.unit->set_breakpoints(breakpoints_);
    board.unit->set_watchpoints(watches_);
  }
}

void GdbServer::send(std::string_view data) { wire_.write(gdb_packet(data)); }

void GdbServer::halted(mcu::DebugUnit& unit, const mcu::Halt& halt) {
  if (ended_) return;
  if (past_) return past_halted(halt);
  const auto at = std::ranges::find(boards_, &unit, &Board::unit);
  stopped_ = chosen_ = static_cast<std::size_t>(at - boards_.begin());
  halt_ = halt;
  for (const Board& board : boards_) board.unit->forget_step();
  if (owes_stop_) send(stop_reply());
  owes_stop_ = false;
  const std::int64_t began_ns = monotonic_now_ns();
  hold();
  stood_ns_ += monotonic_now_ns() - began_ns;
}

// Until GDB says to go on, has left, or the bench is to end.
void GdbServer::hold() {
  if (waiting_for_first_)
    options_.say(fmt::format("gdb: the boards wait at {}; in gdb: target remote {}", wire_.name(),
                             wire_.name().starts_with("tcp:") ? wire_.name().substr(4) : wire_.name()));
  left_ = false;
  while (take_events() != Then::kGoOn && !left_) {
    if (options_.asked_to_end() || wire_.error()) {
      detach();
      break;
    }
    wire_.flush();
    static_cast<void>(
        wait_for(wire_.handle(), kLookEvery_ns, false));  // a client that is gone is seen by listen()
    listen();
  }
  wire_.flush();
  waiting_for_first_ = false;
}

GdbServer::Then GdbServer::take_events() {
  while (std::optional<GdbEvent> event = input_.take()) {
    if (event->kind == GdbEventKind::kBroken) wire_.write(std::vector<std::uint8_t>{'-'});
    if (event->kind != GdbEventKind::kPacket) continue;
    if (!attached_) attach();
    if (command(event->data) == Then::kGoOn) return Then::kGoOn;
  }
  return Then::kStay;
}

std::string GdbServer::stop_reply(std::string_view history) const {
  std::string reply = fmt::format("T{:02x}thread:{:x};{}", signal_of(halt_), stopped_ + 1, history);
  if (halt_.cause == mcu::HaltCause::kWatchpoint) {
    const mcu::AccessWatch& watch = halt_.hit.watch;
    const char* kind = watch.kinds == mcu::kWrites  ? "watch"
                       : watch.kinds == mcu::kReads ? "rwatch"
                                                    : "awatch";
    reply += fmt::format("{}:{:x};", kind, watch.address);
  }
  return reply;
}

void GdbServer::end(int exit_code) {
  if (ended_) return;
  ended_ = true;
  moments_.forget();
  const bool owed = owes_stop_;
  if (attached_ && owed) send(fmt::format("W{:02x}", exit_code & 0xFF));
  wire_.flush();
}

// An action is c, s, C or S with a signal, each with a thread after ':' or for all: the first that names a thread counts.
GdbServer::Then GdbServer::resume(std::string_view actions) {
  std::vector<char> does(boards_.size(), 0);
  while (!actions.empty()) {
    const std::size_t next = actions.find(';');
    std::string_view action = actions.substr(0, next);
    actions.remove_prefix(next == std::string_view::npos ? actions.size() : next + 1);
    if (action.empty()) continue;
    const char what = static_cast<char>(action.front() | 0x20);  // signals mean nothing here
    const std::size_t colon = action.find(':');
    const std::size_t of =
        colon == std::string_view::npos ? boards_.size() : thread_of(action.substr(colon + 1));
    for (std::size_t i = 0; i < boards_.size(); ++i) {
      if (does[i] == 0 && (of == i || of == boards_.size())) does[i] = what;
    }
  }
  if (past_) {
    go_on_in_past(does[stopped_] == 's' ? 's' : 'c');
    return Then::kGoOn;
  }
  stepped_ = std::ranges::find(does, 's') != does.end();
  for (std::size_t i = 0; i < boards_.size(); ++i) {
    Board& board = boards_[i];
    // GDB takes breakpoints away to step over one. Boards that it has not named run all the same and keep theirs.
    if (does[i] != 0) board.unit->set_breakpoints(breakpoints_);
    board.unit->set_watchpoints(watches_);
    if (does[i] == 's') board.unit->step();
  }
  owes_stop_ = true;
  return Then::kGoOn;
}

}  // namespace omnihil
