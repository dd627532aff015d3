// UBC Thunderbots: what a motor board answers over SPI.
//
//   AA BB CC · sequence · what it holds · two int16 (big-endian) · CRC-8/AUTOSAR of all before it
//
// Source: UBC-Thunderbots/MDv6_Firmware (Src/interface.c, frames of ten bytes), UBC-Thunderbots/Software 0139338.
#include "protocols/radio_format.h"
#include "protocols/teams/thunderbots_rows.h"

namespace omnihil {
namespace {

using namespace thunderbots;

template <std::size_t kCount>
constexpr auto answer(const std::array<Field, kCount>& data) {
  return frame("response_type", "what it holds", data);
}
constexpr Field count(std::string_view name, std::string_view what) { return word(name, "", what); }
constexpr auto kSpeedFaults = answer(std::array{
    word("speed", "rpm", "measured speed"),
    enveloped(reserved("faults_11_to_15", 5, "not used")),
    flag("dp_fault", "the driver's protection"),
    flag("overcurr_sw", "overcurrent by the software"),
    flag("sample_fault", "for tests"),
    flag("sw_error", "software"),
    flag("over_curr", "overcurrent"),
    flag("speed_fdbk", "feedback of the speed"),
    flag("start_up", "the start failed"),
    flag("over_temp", "too hot"),
    flag("under_volt", "voltage too low"),
    flag("over_volt", "voltage too high"),
    flag("duration", "the current loop took too long"),
});
constexpr auto kIqId =
    answer(std::array{count("iq", "q current, in counts"), count("id", "d current, in counts")});
constexpr auto kVqVd =
    answer(std::array{count("vq", "q voltage, in counts"), count("vd", "d voltage, in counts")});
constexpr auto kPhase = answer(std::array{count("phase_current", "its amplitude, in counts"),
                                          count("phase_voltage", "its amplitude, in counts")});
constexpr auto kIqRef =
    answer(std::array{count("iq", "q current, in counts"), count("iq_ref", "q current wanted")});
constexpr auto kIdRef =
    answer(std::array{count("id", "d current, in counts"), count("id_ref", "d current wanted")});
constexpr auto kSpeedRef =
    answer(std::array{word("speed", "rpm", "measured speed"), word("speed_ref", "rpm", "speed wanted")});

constexpr std::array kMessages{
    row("speed_and_faults", 1, kSpeedFaults, "After the start, and until another is asked for."),
    row("iq_and_id", 2, kIqId, "Currents."),
    row("vq_and_vd", 3, kVqVd, "Voltages."),
    row("phase_current_and_voltage", 4, kPhase, "Amplitudes."),
    row("iq_and_iq_ref", 5, kIqRef, "Torque loop."),
    row("id_and_id_ref", 6, kIdRef, "Flux loop."),
    row("speed_and_speed_ref", 7, kSpeedRef, "Speed loop."),
};
static_assert(all_tiled(kMessages));

constinit const RadioFormat kFormat{
    .id = "thunderbots-spi-answers",
    .title = "UBC Thunderbots, answers of a motor board",
    .source =
        "https://github.com/UBC-Thunderbots/MDv6_Firmware, https://github.com/UBC-Thunderbots/Software at "
        "0139338",
    .notes =
        "- The other line of [thunderbots-spi](thunderbots-spi.md): codes 1 to 7 mean something else there, "
        "so a frame "
        "does not say by itself which way it goes.\n"
        "- The sequence is that of the frame answered; a board that has nothing to answer sends 0 with its "
        "latest "
        "numbers.\n"
        "- Codes 5 to 7 follow the order in which the sources name them.\n",
    .carrier = {.kind = Carrier::Kind::kSpi},
    .max_frame_bytes = kBytes,
    .messages = kMessages,
};

}  // namespace

const RadioFormat& radio_format_thunderbots_spi_answers() { return kFormat; }

}  // namespace omnihil
