// Names of C++.
#include <cstdint>

namespace robot {
struct Base {
  int id = 0;
};
class Wheel : public Base {
 public:
  static int count;
  float speed = 0;
};
int Wheel::count = 0;
namespace {
Wheel front;
}
template <int N>
struct Filter {
  static double gain;
};
template <int N>
double Filter<N>::gain = N * 0.5;
enum class Mode : std::uint8_t { kOff, kOn = 7 };
Mode mode = Mode::kOff;
}  // namespace robot

extern "C" int names_fill(int) {
  static int calls = 0;
  ++calls;
  robot::front.id = 11;
  robot::front.speed = 2.5f;
  robot::Wheel::count = 4;
  robot::mode = robot::Mode::kOn;
  return static_cast<int>(robot::Filter<3>::gain) + calls;
}
