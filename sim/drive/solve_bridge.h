// A bridge whose voltage depends on the current that it drives (a dead time): both at the end of the sub-step.
//
//   solve_bridge(winding, back_emf_V, current_A, [&] { port.voltage_V -= 0.4 * port.current_A; }, port);
//
// Law: i = the winding's end current under port.voltage_V(i) - opposing voltage, within the bridge's current limit.
// Cannot: take a law that keeps a state, being called several times; know a limit that the voltage alone does not
// respect (the drive's chopper comes afterwards).
#pragma once
#include "sim/drive/implicit_current.h"
#include "sim/drive/winding_step.h"
#include "sim/law/effect_ports.h"

namespace omnihil {

// `law` changes the port's voltage and current limit from what they are at the call. The port is left as the law leaves
// it at the solution; port.current_A is that current. `current_A`: at the sub-step's start.
template <typename T, typename Law>
void solve_bridge(const WindingStep<T>& winding, const T& opposing_V, const T& current_A, const Law& law,
                  BridgePort<T>& port) {
  const T asked_V = port.voltage_V, inverse_limit_per_A = port.inverse_current_limit_per_A;
  implicit_current(current_A, [&](const T& at_A) {
    port.current_A = at_A;
    port.voltage_V = asked_V;
    port.inverse_current_limit_per_A = inverse_limit_per_A;
    law();
    const T end_A = winding.end_current(port.voltage_V - opposing_V, current_A);
    const T& inverse_limit = port.inverse_current_limit_per_A;
    return value_of(inverse_limit) * std::abs(value_of(end_A)) > 1.0 ? T(sign_of(end_A) / inverse_limit)
                                                                     : end_A;
  });
}

}  // namespace omnihil
