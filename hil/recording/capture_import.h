// A capture of another tool as what a recording is made of, and a recording as pieces for the writers of captures.
//
//   const Capture capture = read_capture(text, "field.pcapng", {});
//   CaptureImport log = import_capture(capture, {}, format, "field.pcapng");
//   log.chunks;                              // host's and dongle's bytes, times from start_ns on
//   put_off_to_steps(log.chunks, 1'000'000); // the host's, to when the loop takes them: as parse_radio_log does
//
// Time 0 is a whole `grid_ns` of the capture's time at or before its first piece, so that times on such a grid stay on it.
// A piece that does not say its way (USER0 of pcap, CSV without the column) goes the way of the first packet that the format
// finds in it; one without such a packet is taken as the host's, and counted in the notes.
// Throws BadCapture: nothing of host or dongle in it, a choice to be made (read_capture.h), more than a day.
#pragma once
#include <string>
#include <vector>

#include "hil/capture/read_capture.h"
#include "hil/recording/recording.h"
#include "protocols/radio_format.h"

namespace omnihil {

struct CaptureImport {
  std::vector<RecordedChunk> chunks;
  std::int64_t start_ns = 0;  // time 0 in the capture's time
  bool unix_time = false;     // which is Unix time
  std::vector<std::string> notes;
};

CaptureImport import_capture(const Capture& capture, const CaptureFilter& filter, const RadioFormat& format,
                             const std::string& name, std::int64_t grid_ns = 1'000'000);

// The host's chunks at the first loop step after they were written, all in the order of their times. Returns by how much one
// was put off at most.
std::int64_t put_off_to_steps(std::vector<RecordedChunk>& chunks, std::int64_t step_ns);

// All bytes of a recording as they passed, in Unix time by its epoch.
std::vector<Captured> pieces_of(const Recording& recording);
// The same cut into packets, each at the time of its last byte; pieces that are no packet are there too.
std::vector<Captured> packets_of(const Recording& recording, const RadioFormat& format);

}  // namespace omnihil
