#include "hil/scenario/scenario_rows.h"

#include <algorithm>

namespace omnihil {
namespace {

constexpr StepRow kSteps[] = {
    {StepKind::kCommand, "command", false, false,
     "v_forward_m_s v_left_m_s omega_body_rad_s omega_wheel_rad_s omega_wheel_top_ratio duty_ratio coast "
     "kick_m_s chip_m_s "
     "dribbler_ratio charge",
     "what the host asks for, sent again every command_every_ms until the next command: a body velocity, or "
     "wheel speeds (in rad/s, or as parts of the top speed, at which the back-EMF meets the largest duty of "
     "the supply), or duties (one number for all wheels or four), or coast = true; with it kick_m_s or "
     "chip_m_s "
     "(once the ball is there), dribbler_ratio, charge = true",
     "at_s = 0.1, do = \"command\", v_forward_m_s = 1.0"},
    {StepKind::kDisturb, "disturb", true, false, "force_forward_N force_left_N moment_Nm",
     "a force on the body at its middle, body frame; a moment about the vertical",
     "at_s = 1.0, for_s = 0.2, do = \"disturb\", force_left_N = 5.0"},
    {StepKind::kRadioSilence, "radio_silence", true, false, "", "no packet reaches the robot",
     "at_s = 1.0, do = \"radio_silence\""},
    {StepKind::kBrownOut, "brown_out", true, false, "supply_ratio",
     "the supply dips to this part of its voltage, for bridges and voltage sensor alike",
     "at_s = 1.0, for_s = 0.1, do = \"brown_out\", supply_ratio = 0.6"},
    {StepKind::kEncoderStuck, "encoder_stuck", true, true, "", "the counts stay as they were",
     "at_s = 1.0, do = \"encoder_stuck\", wheels = [2]"},
    {StepKind::kPhaseLost, "phase_lost", true, true, "",
     "the motor's winding is open; of a three-phase drive one leg of the bridge is dead",
     "at_s = 1.0, do = \"phase_lost\", wheels = [0]"},
    {StepKind::kWindingHot, "winding_hot", true, true, "rise_K",
     "the winding is this much hotter than at its rated resistance",
     "at_s = 0.0, do = \"winding_hot\", wheels = [0, 1], rise_K = 80.0"},
    {StepKind::kWheelLifted, "wheel_lifted", true, true, "", "the wheel is in the air",
     "at_s = 1.0, for_s = 0.3, do = \"wheel_lifted\", wheels = [3]"},
    {StepKind::kWheelBlocked, "wheel_blocked", true, true, "", "the wheel stands, whatever turns it",
     "at_s = 0.5, for_s = 1.0, do = \"wheel_blocked\", wheels = [0]"},
    {StepKind::kBall, "ball", false, false, "x_m y_m z_m v_x_m_s v_y_m_s v_z_m_s",
     "the ball is put there, in the field's frame, with this velocity; z_m above the carpet",
     "at_s = 0.0, do = \"ball\", x_m = 0.5, v_x_m_s = -2.0"},
    {StepKind::kRobotAt, "robot_at", false, false, "x_m y_m yaw_rad", "the robot is put there, at rest",
     "at_s = 0.0, do = \"robot_at\", x_m = 3.5, yaw_rad = 0.0"},
    {StepKind::kOpponentAt, "opponent_at", false, false, "opponent x_m y_m yaw_rad",
     "a robot of the other team is put there, at rest; needs opponents = 1 or more",
     "at_s = 0.0, do = \"opponent_at\", opponent = 0, x_m = 1.0"},
    {StepKind::kMark, "mark", false, false, "",
     "robots, motors, batteries and ball are kept as they are, for rewind", "at_s = 0.5, do = \"mark\""},
    {StepKind::kRewind, "rewind", false, false, "",
     "all of it goes back to the last mark, or to the start; firmware, radio and encoder counts go on",
     "at_s = 1.5, do = \"rewind\""},
    {StepKind::kSet, "set", false, false, "name value",
     "a variable of the firmware, by name, is given this value (docs/variables.md)",
     "at_s = 1.0, do = \"set\", name = \"wheel[2].integral\", value = 0.5"},
    {StepKind::kType, "type", false, false, "text",
     "typed at the board's consoles that read (a serial port at its rate, RTT), as it stands: a line's end, "
     "\\r or \\n, "
     "is part of it",
     "at_s = 0.5, do = \"type\", text = \"gain 0.4\\r\\n\""},
    {StepKind::kChip, "flip_ram", false, false, "address bit board",
     "a bit of a byte of the emulated chip's RAM turns over; of all steps on the chip at_s may be any "
     "instant",
     "at_s = 1.000123, do = \"flip_ram\", address = 0x20000010, bit = 3"},
    {StepKind::kChip, "flip_register", false, false, "register bit board",
     "a bit of a core register turns over: 0 to 12, 13 the stack pointer, 14 the link register",
     "at_s = 1.000123, do = \"flip_register\", register = 4, bit = 30"},
    {StepKind::kChip, "flip_flash", false, false, "address bit board",
     "a bit of a byte of the flash turns over, for good",
     "at_s = 1.0, do = \"flip_flash\", address = 0x08000400, bit = 0"},
    {StepKind::kChip, "clock_off", true, false, "ratio board",
     "the chip's oscillators run at this part of their rate",
     "at_s = 1.0, for_s = 0.5, do = \"clock_off\", ratio = 0.99"},
    {StepKind::kChip, "brown_out_reset", false, false, "board",
     "the chip is reset as by its brown-out detector", "at_s = 1.0, do = \"brown_out_reset\""},
    {StepKind::kChip, "interrupt_storm", true, false, "irq rate_Hz board",
     "this interrupt of the chip is raised so often, whoever else raises it",
     "at_s = 1.0, for_s = 0.2, do = \"interrupt_storm\", irq = 37, rate_Hz = 20000.0"},
    {StepKind::kChip, "dma_error", false, false, "board",
     "a DMA transfer that is going on fails: its channel is off, with the error flag",
     "at_s = 1.0, do = \"dma_error\""},
    {StepKind::kChip, "watchdog_late", true, false, "ratio board",
     "the independent watchdog's oscillator runs at this part of its rate",
     "at_s = 1.0, do = \"watchdog_late\", ratio = 0.5"},
};

constexpr CheckRow kChecks[] = {
    {CheckKind::kRiseTime, "rise_time", "s", "s", true, true, "",
     "time from from_s until 90 % of the way to the commanded value is covered"},
    {CheckKind::kOvershoot, "overshoot", "ratio", "", true, true, "",
     "largest excess over the commanded value, as part of the step's height"},
    {CheckKind::kSettlingTime, "settling_time", "s", "s", true, true, "band_ratio",
     "time from from_s after which the value stays within band_ratio of the step's height (0.05)"},
    {CheckKind::kSteadyError, "steady_error", "ratio", "", true, true, "",
     "mean deviation from the commanded value over the window's last fifth, as part of it"},
    {CheckKind::kCommandedSign, "commanded_sign", "", "rad/s", true, true, "",
     "the wheel turns the way it is commanded (mean over the window's last half)"},
    {CheckKind::kStopsAfterSilence, "stops_after_silence", "s", "s", true, false, "standstill_rad_s",
     "time from the start of radio_silence until the wheel stands for good (slower than standstill_rad_s, "
     "1)"},
    {CheckKind::kStopsSafely, "stops_safely", "s", "s", true, false, "standstill_rad_s",
     "time from the start of radio_silence from which on, for good, the wheel stands or its bridge is off"},
    {CheckKind::kWindUp, "wind_up", "ratio", "", true, false, "",
     "largest excess over the commanded wheel speed after a blocked wheel is released, as part of it"},
    {CheckKind::kCurrentLimit, "current_limit", "A", "A", true, false, "", "largest motor current"},
    {CheckKind::kDutyLimit, "duty_limit", "ratio", "", true, false, "",
     "largest duty asked for; requests that no bridge can take fail it, too"},
    {CheckKind::kControlPeriods, "control_periods", "count", "", false, false, "",
     "control periods that were due and did not run"},
    {CheckKind::kWheelOrder, "wheel_order", "", "", false, false, "",
     "each wheel turns at its own commanded speed and not at another's (sizes of the means over the window's "
     "last "
     "half); needs four speeds of different size"},
    {CheckKind::kConsoleSays, "console_says", "s", "s", false, false, "text port board",
     "time from from_s until a line with this text stands on a console of the board; without at_most_s "
     "within "
     "the window"},
    {CheckKind::kConsoleNeverSays, "console_never_says", "", "", false, false, "text port board",
     "no line with this text stands on a console of the board within the window"},
    {CheckKind::kSignal, "signal", "", "", true, false, "signal magnitude",
     "a signal within at_least_… and at_most_… throughout the window; magnitude = true: its size"},
};

}  // namespace

std::span<const StepRow> step_rows() { return kSteps; }
std::span<const CheckRow> check_rows() { return kChecks; }

namespace {
// In the order of ChipFaultKind.
constexpr std::string_view kChipWords[] = {"flip_ram",  "flip_register",   "flip_flash",
                                           "clock_off", "brown_out_reset", "interrupt_storm",
                                           "dma_error", "watchdog_late"};
static_assert(std::size(kChipWords) == kChipFaultKinds);
}  // namespace

std::optional<ChipFaultKind> chip_fault_kind(std::string_view word) {
  const auto found = std::ranges::find(kChipWords, word);
  if (found == std::end(kChipWords)) return std::nullopt;
  return static_cast<ChipFaultKind>(found - std::begin(kChipWords));
}

std::string_view chip_fault_word(ChipFaultKind kind) { return kChipWords[static_cast<std::size_t>(kind)]; }

const StepRow& row_of(StepKind kind) { return *std::ranges::find(kSteps, kind, &StepRow::kind); }

const CheckRow& row_of(CheckKind kind) { return *std::ranges::find(kChecks, kind, &CheckRow::kind); }

}  // namespace omnihil
