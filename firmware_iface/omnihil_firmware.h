/* The boundary between the bench and a robot's firmware, as a plain C ABI.
 *
 * A firmware is one table of functions (omnihil_firmware_api) over an opaque state block that the bench
 * allocates, so that several robots run side by side and a state can be copied. The bench calls, in this
 * order, once per control period: command() or radio_receive() for what the radio brought, tick() with the
 * sensors, radio_transmit() until it returns 0, feedback() when telemetry is wanted. The firmware never
 * blocks, never allocates, never reads a clock: time arrives as now_us. docs/firmware.md has it all.
 *
 * Units are SI and stand in every name. Frames: body x forward, y left, z up, drawn in
 * docs/frames-and-wheels.md. Wheel i sits at wheel_angle_rad[i] from x towards y; its positive direction
 * is the body's counter-clockwise tangent. All-zero bytes are the neutral value of every struct.
 * No pointers in the data structs; the layout is frozen per OMNIHIL_FIRMWARE_ABI (static_assert in tests), but that
 * what the bench hands over may grow at its end.
 *
 * Three-phase robots: the bench also calls motor_tick() once per PWM period of the bridges, inside the time
 * between two tick()s. Members behind feedback() of omnihil_firmware_api were added later: a table whose
 * struct_bytes ends before them is served as ever, and drives by duty.
 */
#ifndef OMNIHIL_FIRMWARE_H
#define OMNIHIL_FIRMWARE_H
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define OMNIHIL_FIRMWARE_ABI 1u
#define OMNIHIL_WHEELS 4
#define OMNIHIL_LEGS 3  /* half bridges of a three-phase motor */
#define OMNIHIL_LOOPS 5 /* gain sets: body x, body y, body omega, body yaw, wheels */

/* omnihil_command.mode */
enum {
  OMNIHIL_MODE_COAST = 0,         /* bridges off: the wheels run free */
  OMNIHIL_MODE_BODY_VELOCITY = 1, /* v_forward_m_s, v_left_m_s, omega_body_rad_s */
  OMNIHIL_MODE_WHEEL_SPEED = 2,   /* omega_wheel_rad_s */
  OMNIHIL_MODE_WHEEL_DUTY = 3     /* duty_ratio, straight to the bridges */
};
/* omnihil_command.flags */
enum {
  OMNIHIL_COMMAND_FIELD_FRAME = 1u << 0, /* velocity is in the field frame; rotate by -yaw first */
  OMNIHIL_COMMAND_YAW_TARGET = 1u << 1,  /* hold yaw_target_rad instead of omega_body_rad_s */
  OMNIHIL_COMMAND_CAMERA_YAW = 1u << 2,  /* camera_yaw_rad is valid */
  OMNIHIL_COMMAND_CHARGE = 1u << 3,      /* charge the kicker's capacitor */
  OMNIHIL_COMMAND_REBOOT = 1u << 4       /* restart the firmware */
};
/* omnihil_command.kick */
enum { OMNIHIL_KICK_NONE = 0, OMNIHIL_KICK_STRAIGHT = 1, OMNIHIL_KICK_CHIP = 2 };
/* omnihil_command.kick_when */
enum { OMNIHIL_KICK_ON_BALL = 0, OMNIHIL_KICK_NOW = 1, OMNIHIL_KICK_AT_YAW = 2 };
/* omnihil_drive.mode[i] */
enum {
  OMNIHIL_DRIVE_COAST = 0,
  OMNIHIL_DRIVE_DUTY = 1,
  OMNIHIL_DRIVE_PHASES = 2 /* as motor_tick() says; three-phase robots only */
};
/* omnihil_motor_drive.leg[i][x] */
enum {
  OMNIHIL_LEG_OFF = 0,  /* both switches open: the phase floats, or its diodes conduct */
  OMNIHIL_LEG_PWM = 1,  /* high for the duty, low for the rest (0: held low, 1: held high) */
  OMNIHIL_LEG_HIGH = 2, /* high for the duty, open for the rest */
  OMNIHIL_LEG_LOW = 3   /* low for the duty, open for the rest */
};
/* omnihil_motor_config.back_emf */
enum { OMNIHIL_BACK_EMF_SINE = 0, OMNIHIL_BACK_EMF_TRAPEZOID = 1 };
/* omnihil_feedback.flags */
enum {
  OMNIHIL_FEEDBACK_COMMAND_TIMEOUT = 1u << 0, /* no valid command within the firmware's timeout */
  OMNIHIL_FEEDBACK_IMU_READY = 1u << 1,
  OMNIHIL_FEEDBACK_BALL_SENSOR_OK = 1u << 2,
  OMNIHIL_FEEDBACK_BALL_SEEN = 1u << 3,
  OMNIHIL_FEEDBACK_DRIBBLER_SEES_BALL = 1u << 4,
  OMNIHIL_FEEDBACK_KICKER_ON = 1u << 5,
  OMNIHIL_FEEDBACK_KICKER_FAULT = 1u << 6,
  OMNIHIL_FEEDBACK_CAPACITOR_CHARGED = 1u << 7
};

/* What the radio asks of one robot, decoded and in SI. */
typedef struct omnihil_command {
  uint32_t mode;      /* OMNIHIL_MODE_* */
  uint32_t flags;     /* OMNIHIL_COMMAND_* */
  uint32_t kick;      /* OMNIHIL_KICK_* */
  uint32_t kick_when; /* OMNIHIL_KICK_* moment */
  double v_forward_m_s;
  double v_left_m_s;
  double omega_body_rad_s; /* counter-clockwise seen from above */
  double omega_wheel_rad_s[OMNIHIL_WHEELS];
  double duty_ratio[OMNIHIL_WHEELS]; /* -1..1 of bus voltage */
  double yaw_target_rad;
  double camera_yaw_rad;
  double a_feedforward_m_s2; /* magnitude and direction of the acceleration the host expects */
  double a_feedforward_angle_rad;
  double v_kick_m_s;     /* 0 where the format gives a pulse instead */
  double kick_pulse_s;   /* 0 where the format gives a speed instead */
  double dribbler_ratio; /* 0..1 */
} omnihil_command;

/* What the robot's board can measure, sampled at now_us. */
typedef struct omnihil_sensors {
  uint64_t now_us;
  int64_t encoder_counts[OMNIHIL_WHEELS]; /* cumulative, signed, rotor shaft, after quadrature */
  double motor_current_A[OMNIHIL_WHEELS]; /* torque-equivalent, mean since the last sample */
  double bus_voltage_V;
  double gyro_z_rad_s;
  double accel_x_m_s2; /* body frame, gravity removed */
  double accel_y_m_s2;
  uint32_t ball_seen; /* the break beam is cut */
  uint32_t reserved;
  double capacitor_V; /* of the kicker; appended: firmware built before does not look so far */
} omnihil_sensors;

/* What the firmware asks of the four bridges. */
typedef struct omnihil_drive {
  uint32_t mode[OMNIHIL_WHEELS]; /* OMNIHIL_DRIVE_* */
  double duty_ratio[OMNIHIL_WHEELS];
  double dribbler_ratio;
  uint32_t kick;
  uint32_t charge;
  double kick_pulse_s;
} omnihil_drive;

/* Controller gains, in the firmware's own scale. Loops: body x, y, omega, yaw, wheels. */
typedef struct omnihil_gains {
  double p[OMNIHIL_LOOPS];
  double i[OMNIHIL_LOOPS];
  double d[OMNIHIL_LOOPS];
  double d2[OMNIHIL_LOOPS];
} omnihil_gains;

/* What the firmware knows of itself: the source of every telemetry packet. */
typedef struct omnihil_feedback {
  uint64_t now_us; /* of the last control period that ran; 0: it does not tell */
  uint32_t flags;  /* OMNIHIL_FEEDBACK_* */
  uint32_t command_age_ms;
  double battery_V;
  double capacitor_V;
  double v_forward_m_s; /* the firmware's own estimate */
  double v_left_m_s;
  double omega_body_rad_s;
  double yaw_rad;
  double accel_x_m_s2;
  double accel_y_m_s2;
  double omega_wheel_rad_s[OMNIHIL_WHEELS];        /* measured by the firmware */
  double omega_wheel_target_rad_s[OMNIHIL_WHEELS]; /* what its wheel loops follow */
  double wheel_accel_rad_s2[OMNIHIL_WHEELS];       /* filtered derivative */
  double wheel_integral[OMNIHIL_WHEELS];
  double duty_ratio[OMNIHIL_WHEELS]; /* what the wheel loops ask for */
  double body_integral[4];           /* body x, y, omega, yaw */
  double body_output[4];
  double body_target[4];
  double body_derivative[4];
  double omega_dribbler_rad_s;
} omnihil_feedback;

/* What is fixed for one robot; handed over once. */
typedef struct omnihil_robot_config {
  uint32_t robot_id;
  uint32_t reserved;
  double wheel_angle_rad[OMNIHIL_WHEELS];
  double wheel_radius_m;
  double wheel_center_radius_m;
  double gear_ratio;                    /* rotor turns per wheel turn */
  double encoder_counts_per_rotor_turn; /* below 0: counts fall with positive rotation */
  double bus_voltage_nominal_V;
  double motor_resistance_ohm;
  double motor_torque_constant_Nm_per_A;
  double command_timeout_s; /* 0: the firmware's own default */
} omnihil_robot_config;

/* The four motors of a three-phase robot; handed over once, after init(). All per phase, to the star point.
 */
typedef struct omnihil_motor_config {
  uint32_t pole_pairs;
  uint32_t back_emf;           /* OMNIHIL_BACK_EMF_* */
  double pwm_frequency_Hz;     /* motor_tick() is called this often */
  double current_sample_ratio; /* instant of the sample within the PWM period, 0: its beginning */
  double phase_resistance_ohm;
  double phase_inductance_d_H;
  double phase_inductance_q_H;
  double flux_linkage_Wb; /* peak back-EMF of a phase over the electrical speed */
  double rotor_inertia_kg_m2;
  double current_limit_A; /* the board's, of a pair of phases; 0: none */
} omnihil_motor_config;

/* What the board's motor interrupt sees in one PWM period, all four motors. */
typedef struct omnihil_motor_sensors {
  uint64_t now_ns; /* of the sample */
  double bus_voltage_V;
  double phase_current_A[OMNIHIL_WHEELS][OMNIHIL_LEGS]; /* into the motor, through shunt and ADC */
  double theta_elec_rad[OMNIHIL_WHEELS];      /* 0 .. 2 pi: the d axis before phase a, by the angle sensor */
  int64_t encoder_counts[OMNIHIL_WHEELS];     /* as in omnihil_sensors */
  uint32_t hall_code[OMNIHIL_WHEELS];         /* H1 + 2 H2 + 4 H3 */
  double leg_V[OMNIHIL_WHEELS][OMNIHIL_LEGS]; /* against the bus's minus, mean of the period; appended */
} omnihil_motor_sensors;

/* The legs of the four bridges from the next PWM period on, where omnihil_drive.mode is PHASES. */
typedef struct omnihil_motor_drive {
  uint32_t leg[OMNIHIL_WHEELS][OMNIHIL_LEGS];          /* OMNIHIL_LEG_* */
  double leg_duty_ratio[OMNIHIL_WHEELS][OMNIHIL_LEGS]; /* 0..1, centre-aligned */
} omnihil_motor_drive;

typedef struct omnihil_firmware_api {
  uint32_t abi_version;       /* OMNIHIL_FIRMWARE_ABI */
  uint32_t struct_bytes;      /* sizeof(omnihil_firmware_api) as the firmware was compiled */
  const char* name;           /* for reports, e.g. "omnihil reference wheel controller" */
  const char* radio_format;   /* format id whose frames radio_receive() decodes, or NULL: commands only */
  uint32_t control_period_us; /* tick() is called exactly this often */
  uint32_t state_bytes;       /* size of the state block the bench allocates (zeroed, 16-byte aligned) */
  int (*init)(void* state, const omnihil_robot_config* config); /* 0, or nonzero: configuration refused */
  void (*command)(void* state, const omnihil_command* command, uint64_t now_us);
  void (*radio_receive)(void* state, const uint8_t* bytes, size_t count, uint64_t now_us);
  size_t (*radio_transmit)(void* state, uint8_t* bytes, size_t capacity); /* one frame, or 0 */
  int (*set_gains)(void* state, const omnihil_gains* gains);              /* 0, or nonzero: refused */
  void (*get_gains)(const void* state, omnihil_gains* gains);
  void (*tick)(void* state, const omnihil_sensors* sensors, omnihil_drive* drive);
  void (*feedback)(const void* state, omnihil_feedback* feedback);
  /* For three-phase robots; NULL: the bridges commutate by themselves, by the duties of tick(). */
  int (*motor_init)(void* state, const omnihil_motor_config* config); /* 0, or nonzero: refused */
  void (*motor_tick)(void* state, const omnihil_motor_sensors* sensors, omnihil_motor_drive* drive);
} omnihil_firmware_api;

/* Seen from outside the library even where everything else is hidden (-fvisibility=hidden). */
#if defined(__GNUC__) && defined(__ELF__)
#define OMNIHIL_EXPORT __attribute__((visibility("default")))
#else
#define OMNIHIL_EXPORT
#endif

/* The one symbol a firmware library exports. Returns NULL when it cannot serve that ABI version. */
OMNIHIL_EXPORT const omnihil_firmware_api* omnihil_firmware_get(uint32_t abi_version);

#ifdef __cplusplus
}
#endif
#endif
