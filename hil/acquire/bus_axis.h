// One axis behind a motor controller on its bus: frames out, samples in.
//
//   BusAxis axis(std::move(wire), kind->host(1), bus_axis_setup(AxisDemand::kVoltage, true, 3.0, true));
//
// Each question has its answer, in order: a sample stands in the middle between the two, since neither way is known to be the
// longer, and is half a round trip off at most (AxisMoment::uncertain_s). Where kLate answers in a
// row leave a question behind them, one was lost on the way, and the count begins anew: a device that takes longer than a period
// is not for that rate. The log is a candump.
//
// A device's q axis has the amplitudes of a phase, models have data sheets' motor of direct current between two terminals: with
// the same torque and the same power V = sqrt(3) V_q, i = sqrt(3)/2 I_q (star winding, sine; the torque constants of the moteus
// and ODrive documents, 0.78 and 8.27 over Kv in rpm/V, have this factor). What is asked and told here is the model's.
#pragma once
#include <deque>
#include <memory>

#include "firmware_iface/motor_bus/frame_wire.h"
#include "firmware_iface/motor_bus/motor_bus.h"
#include "hil/acquire/axis_end.h"

namespace omnihil {

struct BusAxisSetup {
  AxisDemand demand = AxisDemand::kTorque;
  double turns_per_output = 1.0;  // of the bus's shaft
  double device_per_asked = 1.0;  // V_q per V, N m at the bus's shaft per N m at the rotor
  double current_per_told = 1.0;  // A per A of the q axis
};
// `at_rotor`: what a turn on the bus is a turn of, else of the output. `amplitudes`: of its q axis, as above.
BusAxisSetup bus_axis_setup(AxisDemand demand, bool at_rotor, double gear_ratio, bool amplitudes);

class BusAxis final : public AxisEnd {
 public:
  BusAxis(std::unique_ptr<FrameWire> wire, std::unique_ptr<AxisHost> host, const BusAxisSetup& setup)
      : wire_(std::move(wire)), host_(std::move(host)), setup_(setup) {}

  std::string_view name() const override { return wire_->name(); }
  int handle() const override { return wire_->handle(); }
  void ask(double value, std::int64_t now_ns) override;
  void stop(std::int64_t now_ns) override;
  void read(std::int64_t now_ns, std::vector<AxisMoment>& out) override;
  std::string trouble() const override { return host_->state().trouble; }
  std::string lost() const override { return wire_->error() ? wire_->error().message() : ""; }

 private:
  static constexpr int kLate = 10;  // a choice
  void send(std::int64_t now_ns, double value);
  void log(std::int64_t now_ns, const BusFrame& frame);

  std::unique_ptr<FrameWire> wire_;
  std::unique_ptr<AxisHost> host_;
  BusAxisSetup setup_;
  std::vector<BusFrame> frames_;
  struct Question {
    std::int64_t asked_ns;
    double value;
  };
  std::deque<Question> open_;
  int late_ = 0;
};

}  // namespace omnihil
