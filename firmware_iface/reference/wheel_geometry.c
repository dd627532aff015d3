#include "firmware_iface/reference/wheel_geometry.h"

#include <math.h>

/* Inverse of a symmetric 3x3 matrix by cofactors; 0 when it has none. */
static int invert3(float m[3][3], float out[3][3]) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      int a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
      out[i][j] = m[a][c] * m[b][d] - m[a][d] * m[b][c];
    }
  }
  float determinant = m[0][0] * out[0][0] + m[0][1] * out[1][0] + m[0][2] * out[2][0];
  float scale = m[0][0] * m[1][1] * m[2][2];
  if (!(fabsf(determinant) > 1e-4f * scale)) return 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) out[i][j] /= determinant;
  }
  return 1;
}

int wheel_geometry_init(wheel_geometry* geometry, const omnihil_robot_config* config) {
  geometry->wheel_radius_m = (float)config->wheel_radius_m;
  float normal[3][3] = {{0}};
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) {
    float angle = (float)config->wheel_angle_rad[w];
    float* row = geometry->rim_per_body[w];
    row[BODY_X] = -sinf(angle);
    row[BODY_Y] = cosf(angle);
    row[BODY_OMEGA] = (float)config->wheel_center_radius_m;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) normal[i][j] += row[i] * row[j];
    }
  }
  float inverse[3][3];
  if (!invert3(normal, inverse)) return 1;
  /* pinv(A) = (A^T A)^-1 A^T */
  for (int axis = 0; axis < BODY_AXES; ++axis) {
    for (int w = 0; w < OMNIHIL_WHEELS; ++w) {
      float sum = 0.0f;
      for (int k = 0; k < BODY_AXES; ++k) sum += inverse[axis][k] * geometry->rim_per_body[w][k];
      geometry->body_per_rim[axis][w] = sum;
    }
  }
  return 0;
}

void body_to_wheels(const wheel_geometry* geometry, const float body[BODY_AXES],
                    float omega_wheel_rad_s[OMNIHIL_WHEELS]) {
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) {
    const float* row = geometry->rim_per_body[w];
    /* eq. (5), corrected: rim speed over wheel radius */
    omega_wheel_rad_s[w] =
        (row[BODY_X] * body[BODY_X] + row[BODY_Y] * body[BODY_Y] + row[BODY_OMEGA] * body[BODY_OMEGA]) /
        geometry->wheel_radius_m;
  }
}

void wheels_to_body(const wheel_geometry* geometry, const float omega_wheel_rad_s[OMNIHIL_WHEELS],
                    float body[BODY_AXES]) {
  for (int axis = 0; axis < BODY_AXES; ++axis) {
    float sum = 0.0f;
    for (int w = 0; w < OMNIHIL_WHEELS; ++w) sum += geometry->body_per_rim[axis][w] * omega_wheel_rad_s[w];
    body[axis] = sum * geometry->wheel_radius_m;
  }
}

void wrench_to_wheel_torques(const wheel_geometry* geometry, const float wrench[BODY_AXES],
                             float torque_wheel_Nm[OMNIHIL_WHEELS]) {
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) {
    /* rim forces f with A^T f = wrench and smallest norm: f = A (A^T A)^-1 wrench = pinv(A)^T wrench */
    float force_N = 0.0f;
    for (int axis = 0; axis < BODY_AXES; ++axis) force_N += geometry->body_per_rim[axis][w] * wrench[axis];
    torque_wheel_Nm[w] = force_N * geometry->wheel_radius_m;
  }
}

void scale_to_limit(float omega_wheel_rad_s[OMNIHIL_WHEELS], float limit_rad_s) {
  float largest = 0.0f;
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) largest = fmaxf(largest, fabsf(omega_wheel_rad_s[w]));
  if (largest <= limit_rad_s) return;
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) omega_wheel_rad_s[w] *= limit_rad_s / largest;
}
