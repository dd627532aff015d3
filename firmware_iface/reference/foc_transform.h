/* Between three phases and the rotor's frame, and from a voltage to three duties.
 *
 *   foc_dq i = foc_park(foc_clarke(i_a, i_b, i_c), sinf(theta), cosf(theta));
 *   foc_duties(foc_inverse_park(v, s, c), bus_V, duty);
 *
 * Clarke, amplitude kept:  alpha = (2 a - b - c) / 3,  beta = (b - c) / sqrt(3)
 * Park:                    d = alpha cos + beta sin,   q = -alpha sin + beta cos
 * Duties: each phase's voltage over the bus plus 1/2, shifted so that the largest and the smallest lie
 * equally far from the rails (the space vector's pattern): lengths up to bus / sqrt(3) come out undistorted.
 * Source: Clarke 1943, Park 1929; Holmes and Lipo 2003, "Pulse Width Modulation for Power Converters", ch. 5.
 */
#ifndef OMNIHIL_REFERENCE_FOC_TRANSFORM_H
#define OMNIHIL_REFERENCE_FOC_TRANSFORM_H

#ifdef __cplusplus
extern "C" {
#endif

typedef struct foc_alpha_beta {
  float alpha, beta;
} foc_alpha_beta;

typedef struct foc_dq {
  float d, q;
} foc_dq;

foc_alpha_beta foc_clarke(float a, float b, float c);
foc_dq foc_park(foc_alpha_beta x, float sine, float cosine);
foc_alpha_beta foc_inverse_park(foc_dq x, float sine, float cosine);
void foc_duties(foc_alpha_beta voltage_V, float bus_V, float duty_ratio[3]);

#ifdef __cplusplus
}
#endif
#endif
