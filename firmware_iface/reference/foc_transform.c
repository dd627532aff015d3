#include "firmware_iface/reference/foc_transform.h"

#include <math.h>

#define ONE_OVER_ROOT3 0.577350269f
#define HALF_ROOT3 0.866025404f

foc_alpha_beta foc_clarke(float a, float b, float c) {
  foc_alpha_beta x = {(2.0f * a - b - c) / 3.0f, (b - c) * ONE_OVER_ROOT3};
  return x;
}

foc_dq foc_park(foc_alpha_beta x, float sine, float cosine) {
  foc_dq y = {x.alpha * cosine + x.beta * sine, x.beta * cosine - x.alpha * sine};
  return y;
}

foc_alpha_beta foc_inverse_park(foc_dq x, float sine, float cosine) {
  foc_alpha_beta y = {x.d * cosine - x.q * sine, x.d * sine + x.q * cosine};
  return y;
}

void foc_duties(foc_alpha_beta voltage_V, float bus_V, float duty_ratio[3]) {
  float phase_V[3] = {voltage_V.alpha, -0.5f * voltage_V.alpha + HALF_ROOT3 * voltage_V.beta,
                      -0.5f * voltage_V.alpha - HALF_ROOT3 * voltage_V.beta};
  float largest = fmaxf(phase_V[0], fmaxf(phase_V[1], phase_V[2]));
  float smallest = fminf(phase_V[0], fminf(phase_V[1], phase_V[2]));
  float middle = 0.5f * (largest + smallest);
  for (int x = 0; x < 3; ++x) duty_ratio[x] = fmaxf(0.0f, fminf(1.0f, 0.5f + (phase_V[x] - middle) / bus_V));
}
