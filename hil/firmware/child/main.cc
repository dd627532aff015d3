// omnihil_firmware_process SOCKET PAGE: holds one robot's firmware for the bench (wire.h). Started by
// GuardedFirmware, of no use by hand. Whatever the firmware does to this process, the bench goes on.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "firmware_iface/firmware_checks.h"
#include "firmware_iface/firmware_memory.h"
#include "hil/firmware/child/crash_notes.h"
#include "hil/firmware/child/own_memory.h"
#include "hil/firmware/child/state_block.h"
#include "hil/firmware/wire.h"

namespace omnihil {
namespace {

constexpr int kExitStateHurt = 86;  // said to the bench by the page, too

class Process {
 public:
  Process(int socket, WirePage& page) : socket_(socket), page_(page) {}
  int run();

 private:
  bool deal(const WireRequest& request, const std::uint8_t* body);
  void load(const std::string& path);
  std::string open_library(const std::string& path);
  void start(const WireStart& start);
  void tick(const RobotSensors& sensors);
  void motor_tick(const MotorSensors& sensors);
  void take_frames();
  void take_state();
  void answer_state();

  // One call into the firmware, noted on the page; its state block must survive it.
  template <class Work>
  void call(FirmwareCall which, Work&& work) {
    page_.call = which;
    page_.in_firmware = 1;
    work();
    if (block_ && !block_->intact()) {
      page_.crash = CrashKind::kState;
      page_.state_bytes = page_.offset_bytes = static_cast<std::int64_t>(block_->bytes());
      std::_Exit(kExitStateHurt);
    }
    page_.in_firmware = 0;
  }

  template <class T>
  void send(const T& message, std::size_t bytes = sizeof(T)) {
    if (::send(socket_, &message, bytes, MSG_NOSIGNAL) < 0) std::_Exit(0);  // the bench is gone
  }

  static std::uint64_t microseconds(std::int64_t now_ns) {
    return now_ns > 0 ? static_cast<std::uint64_t>(now_ns / 1000) : 0;
  }

  int socket_;
  WirePage& page_;
  omnihil_firmware_api api_{};
  void* library_ = nullptr;
  std::unique_ptr<StateBlock> block_;
  WireTick reply_;
};

std::string Process::open_library(const std::string& path) {
  void* library = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) return std::string("cannot be loaded: ") + ::dlerror();
  using Get = const omnihil_firmware_api* (*)(std::uint32_t);
  const auto get = reinterpret_cast<Get>(::dlsym(library, "omnihil_firmware_get"));
  if (get == nullptr) return "exports no omnihil_firmware_get (firmware_iface/omnihil_firmware.h)";
  const omnihil_firmware_api* api = get(OMNIHIL_FIRMWARE_ABI);
  const std::vector<std::string> faults = check_firmware_api(api);
  if (!faults.empty()) return faults_text("its table cannot be used:", faults);
  api_ = table_of(api);
  library_ = library;
  return {};
}

void Process::load(const std::string& path) {
  WireLoaded loaded{};
  std::string problem;
  call(FirmwareCall::kLoad, [&] { problem = open_library(path); });
  std::string text = problem;
  if (problem.empty()) {
    const std::string name = std::string(api_.name).substr(0, kWireTextBytes / 2);
    const std::string radio = api_.radio_format != nullptr ? api_.radio_format : "";
    text = name + radio.substr(0, kWireTextBytes / 2);
    loaded.name_bytes = static_cast<std::uint32_t>(name.size());
    loaded.radio_bytes = static_cast<std::uint32_t>(text.size() - name.size());
    loaded.control_period_us = api_.control_period_us;
    loaded.state_bytes = api_.state_bytes;
    loaded.has_motor_tick = api_.motor_tick != nullptr ? 1 : 0;
  }
  text = text.substr(0, kWireTextBytes);
  loaded.problem_bytes = problem.empty() ? 0 : static_cast<std::uint32_t>(text.size());
  std::memcpy(loaded.text, text.data(), text.size());
  send(loaded);
}

void Process::start(const WireStart& start) {
  block_ = std::make_unique<StateBlock>(api_.state_bytes);
  watch_state(block_.get());
  call(FirmwareCall::kInit, [&] { reply_.code = api_.init(block_->data(), &start.config); });
  if (reply_.code == 0 && start.has_motors != 0 && api_.motor_init != nullptr) {
    call(FirmwareCall::kMotorInit, [&] { reply_.code = api_.motor_init(block_->data(), &start.motors); });
  }
  if (reply_.code == 0) take_state();
  answer_state();
}

void Process::take_state() {
  reply_.feedback = {};
  call(FirmwareCall::kFeedback, [&] { api_.feedback(block_->data(), &reply_.feedback); });
  reply_.gains = {};
  call(FirmwareCall::kGetGains, [&] { api_.get_gains(block_->data(), &reply_.gains); });
}

void Process::take_frames() {
  if (api_.radio_transmit == nullptr) return;
  for (int n = 0; n < kWireFrames; ++n) {
    WireFrame& frame = reply_.frame[reply_.frames];
    std::size_t bytes = 0;
    call(FirmwareCall::kRadioTransmit,
         [&] { bytes = api_.radio_transmit(block_->data(), frame.data, sizeof frame.data); });
    if (bytes == 0) break;
    if (bytes > sizeof frame.data) {
      ++reply_.frames_refused;
      break;
    }
    frame.bytes = static_cast<std::uint32_t>(bytes);
    ++reply_.frames;
  }
}

void Process::answer_state() {
  send(reply_, offsetof(WireTick, frame) + reply_.frames * sizeof(WireFrame));
  reply_.frames = reply_.frames_refused = 0;
}

void Process::tick(const RobotSensors& sensors) {
  ++page_.ticks;
  page_.now_ns = static_cast<std::int64_t>(sensors.now_us) * 1000;
  reply_.drive = {};
  call(FirmwareCall::kTick, [&] { api_.tick(block_->data(), &sensors, &reply_.drive); });
  take_frames();
  take_state();
  answer_state();
}

void Process::motor_tick(const MotorSensors& sensors) {
  MotorDrive drive{};
  if (api_.motor_tick != nullptr) {
    call(FirmwareCall::kMotorTick, [&] { api_.motor_tick(block_->data(), &sensors, &drive); });
  }
  send(drive);
}

template <class T>
T value_of(const std::uint8_t* body) {
  T value;
  std::memcpy(&value, body, sizeof value);
  return value;
}

bool Process::deal(const WireRequest& request, const std::uint8_t* body) {
  const std::uint64_t now_us = microseconds(request.now_ns);
  switch (request.call) {
    case FirmwareCall::kLoad:
      load(std::string(reinterpret_cast<const char*>(body), request.count));
      break;
    case FirmwareCall::kInit:
      start(value_of<WireStart>(body));
      break;
    case FirmwareCall::kCommand: {
      const auto command = value_of<RobotCommand>(body);
      call(FirmwareCall::kCommand, [&] { api_.command(block_->data(), &command, now_us); });
      break;
    }
    case FirmwareCall::kRadioReceive:
      if (api_.radio_receive == nullptr) break;
      call(FirmwareCall::kRadioReceive,
           [&] { api_.radio_receive(block_->data(), body, request.count, now_us); });
      break;
    case FirmwareCall::kSetGains: {
      const auto gains = value_of<RobotGains>(body);
      call(FirmwareCall::kSetGains, [&] { reply_.code = api_.set_gains(block_->data(), &gains); });
      take_state();
      answer_state();
      break;
    }
    case FirmwareCall::kTick:
      tick(value_of<RobotSensors>(body));
      break;
    case FirmwareCall::kMotorTick:
      motor_tick(value_of<MotorSensors>(body));
      break;
    case FirmwareCall::kPeek: {
      const std::vector<std::uint8_t> answer = peek({body, request.count}, library_, block_.get());
      send(*answer.data(), answer.size());
      break;
    }
    case FirmwareCall::kPoke:
      send(poke({body, request.count}, library_, block_.get()));
      break;
    default:
      return false;
  }
  return true;
}

int Process::run() {
  std::vector<std::uint8_t> message(64 * 1024);
  for (;;) {
    const ssize_t got = ::recv(socket_, message.data(), message.size(), 0);
    if (got < static_cast<ssize_t>(sizeof(WireRequest))) return 0;  // the bench is gone
    if (!deal(value_of<WireRequest>(message.data()), message.data() + sizeof(WireRequest))) return 1;
  }
}

int serve_firmware(int argc, char** argv) {
  if (argc != 3) return 2;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // never outlives the bench
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  const int nothing = ::open("/dev/null", O_RDONLY);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(STDERR_FILENO, STDOUT_FILENO);  // what a firmware prints is no output of the bench
  const int page_file = std::atoi(argv[2]);
  void* page = ::mmap(nullptr, sizeof(WirePage), PROT_READ | PROT_WRITE, MAP_SHARED, page_file, 0);
  if (page == MAP_FAILED) return 2;
  install_crash_notes(static_cast<WirePage*>(page));
  return Process(std::atoi(argv[1]), *static_cast<WirePage*>(page)).run();
}

}  // namespace
}  // namespace omnihil

int main(int argc, char** argv) { return omnihil::serve_firmware(argc, argv); }
