/* Loads an MJCF in MuJoCo and runs it: what an independent program makes of the export.
 *
 *   mujoco_client FILE.xml SECONDS DUTY1 DUTY2 DUTY3 DUTY4
 *
 * Prints words and numbers: mass, centre of mass, yaw inertia about the origin, bodies; then, after it has settled for 0.3 s and
 * run for SECONDS, the displacement and speed of the base in its starting frame, and the wheels' speeds. */
#include <math.h>
#include <mujoco/mujoco.h>
#include <stdio.h>
#include <stdlib.h>

static void print_masses(const mjModel* m, const mjData* d) {
  double mass = 0, com[3] = {0, 0, 0}, yaw = 0;
  for (int b = 1; b < m->nbody; ++b) {
    const double* at = d->xipos + 3 * b;
    const double* r = d->ximat + 9 * b;
    const double* inertia = m->body_inertia + 3 * b;
    mass += m->body_mass[b];
    for (int i = 0; i < 3; ++i) com[i] += m->body_mass[b] * at[i];
    yaw += m->body_mass[b] * (at[0] * at[0] + at[1] * at[1]);
    for (int i = 0; i < 3; ++i) yaw += r[6 + i] * r[6 + i] * inertia[i]; /* zz of R diag(I) R^T */
  }
  printf("mass %.17g\ncom %.17g %.17g %.17g\nyaw %.17g\nbodies %d\nactuators %d\n", mass, com[0] / mass,
         com[1] / mass, com[2] / mass, yaw, m->nbody, m->nu);
}

int main(int argc, char** argv) {
  char error[1000] = "";
  if (argc != 7) return 2;
  mjModel* m = mj_loadXML(argv[1], NULL, error, sizeof error);
  if (m == NULL) {
    printf("error %s\n", error);
    return 1;
  }
  mjData* d = mj_makeData(m);
  mj_forward(m, d);
  print_masses(m, d);
  while (d->time < 0.3) mj_step(m, d);
  const double x0 = d->qpos[0], y0 = d->qpos[1];
  for (int i = 0; i < m->nu && i < 4; ++i) d->ctrl[i] = atof(argv[3 + i]);
  const double end = d->time + atof(argv[2]);
  while (d->time < end) mj_step(m, d);
  printf("moved %.9g %.9g\nspeed %.9g %.9g %.9g\nheight %.9g\nwheels", d->qpos[0] - x0, d->qpos[1] - y0,
         d->qvel[0], d->qvel[1], d->qvel[5], d->qpos[2]);
  for (int i = 1; i <= 4; ++i) {
    char name[sizeof "wheel_" + 11];  // an int has at most eleven characters
    snprintf(name, sizeof name, "wheel_%d", i);
    printf(" %.9g", d->qvel[m->jnt_dofadr[mj_name2id(m, mjOBJ_JOINT, name)]]);
  }
  printf("\n");
  mj_deleteData(d);
  mj_deleteModel(m);
  return 0;
}
