// Signals from block to block within a chip: what a timer sends to ADCs and to other timers.
//
//   const int source = bus.source("TIM1_TRGO");              // its sender names itself: source(name, this)
//   bus.listen(source, adc, true);       // only what is listened to is scheduled by its sender
//   bus.fire(source, true);              // rising edge, at system.now()
#pragma once
#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "firmware_iface/mcu/peripheral.h"

namespace omnihil::mcu {

class TriggerSink {
 public:
  virtual ~TriggerSink() = default;
  virtual void triggered(int source, bool rising) = 0;
};

class TriggerSender {
 public:
  virtual ~TriggerSender() = default;
  virtual void heard_changed() = 0;  // somebody has begun or ceased to listen to one of its signals
};

class TriggerBus {
 public:
  explicit TriggerBus(System& system) : system_(system) {}
  int source(std::string_view name, TriggerSender* sender = nullptr) {
    std::size_t i = 0;
    while (i < lines_.size() && lines_[i].name != name) ++i;
    if (i == lines_.size()) {
      lines_.push_back({std::string(name), {}});
      heard_.push_back(0);
    }
    if (sender != nullptr) lines_[i].sender = sender;
    return static_cast<int>(i);
  }
  void listen(int source, TriggerSink& sink, bool on) {
    auto& sinks = lines_[static_cast<std::size_t>(source)].sinks;
    const auto at = std::find(sinks.begin(), sinks.end(), &sink);
    if (on == (at != sinks.end())) return;
    if (on) {
      sinks.push_back(&sink);
    } else {
      sinks.erase(at);
    }
    heard_[static_cast<std::size_t>(source)] = sinks.empty() ? 0 : 1;
    ++version_;
    if (TriggerSender* sender = lines_[static_cast<std::size_t>(source)].sender) sender->heard_changed();
    system_.reschedule();
  }
  std::uint32_t version() const { return version_; }  // another one: somebody began or ceased to listen
  bool heard(int source) const { return heard_[static_cast<std::size_t>(source)] != 0; }
  void fire(int source, bool rising) {
    const auto& listening = lines_[static_cast<std::size_t>(source)].sinks;
    if (listening.size() == 1) return listening.front()->triggered(source, rising);
    const auto sinks = listening;  // a sink may stop listening meanwhile
    for (TriggerSink* sink : sinks) sink->triggered(source, rising);
  }

 private:
  struct Line {
    std::string name;
    std::vector<TriggerSink*> sinks;
    TriggerSender* sender = nullptr;
  };
  System& system_;
  std::vector<Line> lines_;
  std::vector<char> heard_;  // by line: somebody listens
  std::uint32_t version_ = 0;
};

}  // namespace omnihil::mcu
