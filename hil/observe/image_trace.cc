#include "hil/observe/image_trace.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>

#include "firmware_iface/mcu/stm32/timer/timer.h"
#include "hil/observe/call_tracker.h"
#include "hil/observe/exception_names.h"
#include "hil/observe/rtos_task.h"
#include "hil/text/json_text.h"

namespace omnihil {
namespace {

struct Event {
  std::int64_t at_ns = 0;
  CallEvent::Kind kind = CallEvent::Kind::kEnter;
  int which = 0;
  std::uint32_t sp = 0;
  std::uint32_t task = 0;     // 0: none, or none yet
  bool in_exception = false;  // on the stack of interrupts
};

bool begins_something(CallEvent::Kind kind) {
  return kind == CallEvent::Kind::kEnter || kind == CallEvent::Kind::kExceptionBegins;
}

std::string quoted(const std::string& text) { return json_text(nlohmann::ordered_json(text)); }

}  // namespace

class ImageTrace::Board final {
 public:
  Board(const TraceOptions& options, mcu::McuFirmware& firmware, mcu::McuBoard& board,
        const mcu::ElfImage& image, std::uint32_t robot_id, int number)
      : options_(options),
        firmware_(&firmware),
        machine_(&board.machine()),
        tracker_(image, board.machine(), [this](const CallEvent& event) { take(event); }),
        robot_id_(robot_id),
        number_(number),
        running_(image, board.machine()) {
    const std::string& timer = board.spec().control_timer;
    if (!timer.empty()) control_ = 16 + board.chip().find<mcu::Timer>(timer)->spec().irq_update;
    if (running_.known()) tracker_.follow_tasks([this] { return running_.now(); });
    machine_->observe(&tracker_);
  }

  bool is_of(const mcu::McuFirmware& firmware) const { return firmware_ == &firmware; }
  bool over() const { return machine_ == nullptr; }
  void end() {
    end_ns_ = machine_->to_ns(machine_->now());
    machine_->observe(nullptr);
    machine_ = nullptr;
    firmware_ = nullptr;
  }
  std::size_t events() const { return events_.size(); }
  bool dropped() const { return dropped_; }
  void write(std::string& out) const;

 private:
  std::string name(const Event& event) const {
    if (event.kind == CallEvent::Kind::kExceptionBegins || event.kind == CallEvent::Kind::kExceptionEnds) {
      return exception_name(event.which);
    }
    return tracker_.functions()[static_cast<std::size_t>(event.which)];
  }

  void take(const CallEvent& event) {
    if (machine_ == nullptr) return;  // what was open when the run was over ends with it
    const bool function = event.kind == CallEvent::Kind::kEnter || event.kind == CallEvent::Kind::kLeave;
    if (function &&
        !passes_filter(options_.filter, tracker_.functions()[static_cast<std::size_t>(event.which)]))
      return;
    const std::int64_t at_ns = machine_->to_ns(static_cast<mcu::Cycles>(event.at / mcu::kSubcycles));
    const bool tasks = running_.known();
    Event kept{at_ns,    event.kind,      event.which,
               event.sp, tracker_.task(), tasks && (!function || tracker_.in_exception())};
    if (kept.task != 0 && !names_.contains(kept.task)) names_.emplace(kept.task, running_.name(kept.task));
    std::uint32_t& highest = highest_sp_[stack_of(kept)];
    highest = std::max(highest, event.sp);
    events_.push_back(kept);
    const auto keep_ns = static_cast<std::int64_t>(options_.last_s * 1e9);
    while (keep_ns > 0 && events_.front().at_ns < at_ns - keep_ns) forget();
    for (; events_.size() > options_.most; dropped_ = true) forget();
  }

  std::string stack_of(const Event& event) const {
    if (event.in_exception) return "stack interrupts";
    return event.task == 0 ? "stack" : "stack " + names_.at(event.task);
  }

  // What is open where the rest begins.
  void forget() {
    const Event& first = events_.front();
    if (begins_something(first.kind)) {
      open_.push_back(first);
    } else if (!open_.empty()) {
      open_.pop_back();
    }
    events_.pop_front();
  }

  TraceOptions options_;
  bool dropped_ = false;
  mcu::McuFirmware* firmware_;
  mcu::Machine* machine_;  // null: its run is over
  CallTracker tracker_;
  std::uint32_t robot_id_;
  int number_, control_ = -1;
  std::int64_t end_ns_ = 0;
  RunningTask running_;
  std::map<std::uint32_t, std::string> names_;       // of tasks
  std::map<std::string, std::uint32_t> highest_sp_;  // by stack
  std::deque<Event> events_;
  std::vector<Event> open_;
};

void ImageTrace::Board::write(std::string& out) const {
  // Threads: the board's, and one for each task.
  constexpr int kMostTasks = 1000;
  const auto thread_of = [this](std::uint32_t task) {
    const auto known = names_.find(task);
    if (known == names_.end()) return number_;
    return (number_ + 1) * kMostTasks + static_cast<int>(std::distance(names_.begin(), known));
  };
  std::uint32_t task = 0;
  const auto line = [&](const char* phase, std::int64_t at_ns, const std::string& rest) {
    out += fmt::format(",\n{{\"ph\":\"{}\",\"pid\":{},\"tid\":{},\"ts\":{}.{:03}{}}}", phase, robot_id_,
                       thread_of(task), at_ns / 1000, at_ns % 1000, rest);
  };
  line("M", 0, fmt::format(",\"name\":\"process_name\",\"args\":{{\"name\":\"robot {}\"}}", robot_id_));
  line("M", 0, fmt::format(",\"name\":\"thread_name\",\"args\":{{\"name\":\"board {}\"}}", number_));
  for (const auto& [of, called] : names_) {
    task = of;
    line("M", 0,
         fmt::format(",\"name\":\"thread_name\",\"args\":{{\"name\":{}}}",
                     quoted(fmt::format("board {} {}", number_, called))));
  }
  const std::int64_t from_ns = events_.empty() ? 0 : events_.front().at_ns;
  std::vector<Event> open = open_;
  for (const Event& event : open_) {
    task = event.task;
    line("B", from_ns, fmt::format(",\"name\":{}", quoted(name(event))));
  }
  std::int64_t control_ns = -1;
  for (const Event& event : events_) {
    task = event.task;
    if (begins_something(event.kind)) {
      open.push_back(event);
      line("B", event.at_ns, fmt::format(",\"name\":{}", quoted(name(event))));
    } else if (!open.empty()) {
      open.pop_back();
      line("E", event.at_ns, "");
    }
    line("C", event.at_ns,
         fmt::format(",\"name\":{},\"args\":{{\"bytes\":{}}}", quoted(stack_of(event)),
                     highest_sp_.at(stack_of(event)) - event.sp));
    if (event.kind != CallEvent::Kind::kExceptionBegins || event.which != control_) continue;
    if (control_ns >= 0) {
      line("C", event.at_ns,
           fmt::format(",\"name\":\"control period\",\"args\":{{\"us\":{:.3f}}}",
                       static_cast<double>(event.at_ns - control_ns) * 1e-3));
    }
    control_ns = event.at_ns;
  }
  const std::int64_t end_ns = machine_ != nullptr ? machine_->to_ns(machine_->now()) : end_ns_;
  for (; !open.empty(); open.pop_back()) {
    task = open.back().task;
    line("E", std::max(end_ns, from_ns), "");
  }
}

ImageTrace::ImageTrace(TraceOptions options) : options_(std::move(options)) {}
ImageTrace::~ImageTrace() = default;

void ImageTrace::begins(mcu::McuFirmware& firmware, const mcu::ElfImage& image, std::uint32_t robot_id) {
  for (int b = 0; b < firmware.boards(); ++b)
    boards_.push_back(std::make_unique<Board>(options_, firmware, firmware.board(b), image, robot_id, b));
}

void ImageTrace::ends(mcu::McuFirmware& firmware) {
  for (const auto& board : boards_) {
    if (board->is_of(firmware)) board->end();
  }
}

void ImageTrace::clear() {
  std::erase_if(boards_, [](const auto& board) { return board->over(); });
}

std::size_t ImageTrace::events() const {
  std::size_t count = 0;
  for (const auto& board : boards_) count += board->events();
  return count;
}

bool ImageTrace::dropped() const {
  return std::ranges::any_of(boards_, [](const auto& board) { return board->dropped(); });
}

std::string ImageTrace::text() const {
  std::string text;
  for (const auto& board : boards_) board->write(text);
  return "{\"displayTimeUnit\":\"ns\",\"traceEvents\":[" + (text.empty() ? "" : text.substr(1)) + "\n]}\n";
}

}  // namespace omnihil
