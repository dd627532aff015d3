// Back in time: the board that halted is shown as it was, in copies of this process (gdb_moments.h), to which GDB is handed over
// until it wants elsewhere. Law: GDB manual, "Remote Protocol": bs, bc; replaylog of stop replies.
//
// A position is instructions of the board times 16, and how many exceptions have begun since the last of them: exceptions begin
// between two instructions.
#include <fmt/format.h>

#include <algorithm>

#include "hil/debugger/gdb_server.h"

namespace omnihil {
namespace {

constexpr std::uint64_t kPlaces = 16;            // at one instruction
constexpr mcu::Cycles kFar = 1'000'000'000'000;  // longer than any run of a board

std::uint64_t instructions_of(mcu::DebugUnit& unit) { return unit.machine().cpu().statistics.instructions; }
std::uint32_t level_of(mcu::DebugUnit& unit) {
  return static_cast<std::uint32_t>(unit.machine().nvic().active_count());
}

}  // namespace

// One instruction after the other, each of which is told.
struct GdbServer::PastRun final : mcu::MachineObserver {
  PastRun(mcu::DebugUnit& of, PastOrder wanted) : unit(of), order(std::move(wanted)) {}
  void exception_begins(int, mcu::Cycles) override { unit.ask(); }  // told of when it has begun

  mcu::DebugUnit& unit;
  PastOrder order;
  PastReport report;
  bool arrived = false;
  char resume = 0;
  std::uint64_t at = 0;    // position
  std::uint64_t from = 0;  // of the last resumption
  std::uint32_t from_level = 0;
};

void GdbServer::KeepPast::operator()(PastRun* run) const { delete run; }

GdbTalk GdbServer::talk() const { return {acks_, chosen_, breakpoints_, watches_}; }

void GdbServer::take_talk(const GdbTalk& talk) {
  acks_ = talk.acks;
  chosen_ = static_cast<std::size_t>(talk.chosen);
  breakpoints_ = talk.breakpoints;
  watches_ = talk.watches;
}

// Only while something may halt it: a bench that just runs is not slowed down.
void GdbServer::keep_moment(mcu::DebugUnit& unit) {
  if (!attached_ || !keeps_past_ || (!stepped_ && breakpoints_.empty() && watches_.empty()))
    return moments_.forget();
  if (std::optional<PastOrder> order = moments_.keep(&unit, instructions_of(unit)))
    be_past(unit, std::move(*order));
}

void GdbServer::be_past(mcu::DebugUnit& unit, PastOrder order) {
  moments_.mute_all_but(wire_.handle());
  past_.reset(new PastRun(unit, std::move(order)));
  take_talk(past_->order.talk);
  stopped_ = static_cast<std::size_t>(past_->order.plain.board);
  halt_ = {mcu::HaltCause::kStep};
  unit.set_breakpoints({});  // they are looked for at each instruction
  unit.set_watchpoints(watches_);
  unit.machine().observe(past_.get(), false);
  unit.ask();
  unit.machine().run_until(unit.machine().now() + kFar);
  leave_past('d');
}

void GdbServer::leave_past(char what) {
  past_->report.plain.what = what;
  past_->report.plain.at = past_->at;
  past_->report.plain.level = level_of(past_->unit);
  past_->report.plain.resume = past_->resume;
  past_->report.talk = talk();
  wire_.flush();
  moments_.report(past_->report);
}

void GdbServer::past_halted(const mcu::Halt& halt) {
  PastRun& past = *past_;
  const PastOrder::Plain& order = past.order.plain;
  const std::uint64_t place = kPlaces * instructions_of(past.unit), last = past.at;
  past.at = place > last ? place : last + (halt.cause == mcu::HaltCause::kAsked ? 1 : 0);
  const bool by_itself = halt.cause != mcu::HaltCause::kAsked && halt.cause != mcu::HaltCause::kStep;
  const std::uint32_t pc = past.unit.machine().cpu().reg.r[15];
  const bool broken = std::ranges::find(breakpoints_, pc) != breakpoints_.end();
  if (order.scan) {
    PastReport::Plain& found = past.report.plain;
    // An access is told of behind it, even right here: GDB takes it to be ahead and steps back over it.
    const bool access = halt.cause == mcu::HaltCause::kWatchpoint && past.at <= order.until;
    const bool before = past.at < order.until;
    if (access || (before && (broken || by_itself))) {
      found.halt_found = true;
      found.halt_at = past.at;
      found.halt = by_itself ? halt : mcu::Halt{mcu::HaltCause::kBreakpoint};
    }
    if (!before) leave_past('f');
    if (level_of(past.unit) <= order.level) found.step_found = true, found.step_at = past.at;
  } else if (!past.arrived) {
    past.arrived = past.at >= order.until;
    past.resume = order.resume;
    past.from = past.at;
    past.from_level = level_of(past.unit);
    if (past.arrived && past.resume == 0) stand_in_past(past.order.reply);
  } else {
    const bool stepped = past.resume == 's' && past.at > past.from && level_of(past.unit) <= past.from_level;
    const bool over = past.at >= order.end;
    if ((broken || by_itself || stepped) && !(over && order.last)) {
      halt_ = by_itself ? halt : mcu::Halt{broken ? mcu::HaltCause::kBreakpoint : mcu::HaltCause::kStep};
      stand_in_past(stop_reply());
    } else if (over) {
      leave_past('e');
    }
  }
  past.unit.step();
}

void GdbServer::go_on_in_past(char how) { past_->resume = how; }

// GDB is talked to until it wants to go forward from here; all else ends this copy.
void GdbServer::stand_in_past(const std::string& reply) {
  past_->resume = 0;
  send(reply);
  hold();
  if (past_->resume == 0) leave_past('d');
  past_->from = past_->at;
  past_->from_level = level_of(past_->unit);
  past_->unit.set_watchpoints(watches_);
}

// From now; back when GDB is here again, or has left.
GdbServer::Then GdbServer::go_back(char how) {
  mcu::DebugUnit& unit = *boards_[stopped_].unit;
  const std::vector<std::size_t> mine = moments_.of(&unit);
  const std::uint64_t now = kPlaces * instructions_of(unit);
  const auto begin_of = [&](std::size_t i) { return kPlaces * moments_.begin(mine[i]); };
  const auto end_of = [&](std::size_t i) { return i + 1 < mine.size() ? begin_of(i + 1) : now; };
  std::uint64_t from = now;
  std::uint32_t level = level_of(unit);
  wire_.flush();
  for (;;) {
    PastOrder order;
    order.plain.board = stopped_;
    order.plain.level = level;
    order.plain.scan = true;
    std::optional<PastReport> report;
    bool found = false;
    std::size_t i = mine.size();
    halt_ = {mcu::HaltCause::kStep};
    while (i > 0 && !found) {
      if (begin_of(--i) >= from) continue;
      order.plain.until = std::min(from, end_of(i));
      order.talk = talk();
      report = moments_.ask(mine[i], order, options_.asked_to_end);
      if (!report) return lose_past();
      const PastReport::Plain& seen = report->plain;
      const bool halts =
          seen.halt_found && (how == 'c' || (seen.halt_at < from && seen.halt_at >= seen.step_at));
      found = halts || (how == 's' && seen.step_found);
      if (halts) {
        order.plain.until = seen.halt_at;
        halt_ = seen.halt;
      } else if (found) {
        order.plain.until = seen.step_at;
      }
    }
    order.reply = found ? stop_reply() : stop_reply("replaylog:begin;");
    if (mine.empty()) {
      send(order.reply);
      return Then::kStay;
    }
    if (!found) order.plain.until = begin_of(0);
    order.plain.scan = false;
    do {
      order.plain.last = i + 1 == mine.size();
      order.plain.end = end_of(i);
      order.talk = talk();
      report = moments_.ask(mine[i], order, options_.asked_to_end);
      if (!report) return lose_past();
      take_talk(report->talk);
      if (report->plain.what != 'e') break;
      order.plain.resume = report->plain.resume;
      if (++i < mine.size()) order.plain.until = begin_of(i);
    } while (i < mine.size());
    if (i == mine.size()) {
      halt_ = {mcu::HaltCause::kStep};
      send(stop_reply("replaylog:end;"));
      return Then::kStay;
    }
    if (report->plain.what == 'd') {
      send("OK");
      detach();
      return Then::kGoOn;
    }
    how = report->plain.what;
    from = report->plain.at;
    level = report->plain.level;
  }
}

// Whoever showed it is gone: GDB stands in the present again.
GdbServer::Then GdbServer::lose_past() {
  moments_.forget();
  halt_ = {mcu::HaltCause::kAsked};
  send(stop_reply("replaylog:end;"));
  return Then::kStay;
}

}  // namespace omnihil
