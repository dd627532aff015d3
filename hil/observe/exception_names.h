// What people call an exception of a Cortex-M by its number: "IRQ 54", "SysTick", "PendSV".
//
//   exception_name(16 + 54);
#pragma once
#include <fmt/format.h>

#include <string>

namespace omnihil {

inline std::string exception_name(int exception) {
  if (exception >= 16) return fmt::format("IRQ {}", exception - 16);
  switch (exception) {  // DDI 0403E.e B1.5.2
    case 2:
      return "NMI";
    case 3:
      return "HardFault";
    case 4:
      return "MemManage";
    case 5:
      return "BusFault";
    case 6:
      return "UsageFault";
    case 11:
      return "SVCall";
    case 14:
      return "PendSV";
    case 15:
      return "SysTick";
    default:
      return fmt::format("exception {}", exception);
  }
}

}  // namespace omnihil
