#include "hil/firmware/firmware_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string_view>
#include <system_error>

#include "hil/firmware/child_socket.h"
#include "hil/firmware/signal_words.h"
#include "hil/text/program_files.h"

namespace omnihil {
namespace {

constexpr const char* kProgram = "omnihil_firmware_process";

[[noreturn]] void fail(const std::string& what) {
  throw std::system_error(errno, std::generic_category(), "firmware process: " + what);
}

// proc(5): the process that traces it, 0 for none.
bool is_traced(pid_t process) {
  std::ifstream status(fmt::format("/proc/{}/status", process));
  constexpr std::string_view kKey = "TracerPid:";
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(kKey)) return std::atoi(line.c_str() + kKey.size()) != 0;
  }
  return false;
}

}  // namespace

FirmwareProcess::FirmwareProcess(double deadline_s) : deadline_s_(deadline_s), in_(64 * 1024) { start(); }

FirmwareProcess::~FirmwareProcess() {
  if (socket_ >= 0) ::close(socket_);
  if (child_ > 0) {
    ::kill(child_, SIGKILL);
    ::waitpid(child_, nullptr, 0);
  }
  if (page_ != nullptr) ::munmap(page_, sizeof(WirePage));
}

void FirmwareProcess::start() {
  const int page_file = ::memfd_create("omnihil firmware", 0);
  if (page_file < 0 || ::ftruncate(page_file, sizeof(WirePage)) != 0) fail("shared page");
  void* page = ::mmap(nullptr, sizeof(WirePage), PROT_READ | PROT_WRITE, MAP_SHARED, page_file, 0);
  if (page == MAP_FAILED) fail("shared page");
  page_ = new (page) WirePage();
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0) fail("socket pair");
  const std::string path = helper_program(kProgram);
  const std::string socket_word = std::to_string(ends[1]), page_word = std::to_string(page_file);
  const char* words[] = {path.c_str(), socket_word.c_str(), page_word.c_str(), nullptr};
  child_ = ::fork();
  if (child_ == 0) {  // only what is allowed between fork and exec
    ::fcntl(ends[1], F_SETFD, 0);
    ::execvp(path.c_str(), const_cast<char* const*>(words));
    ::_exit(127);
  }
  const int error = errno;
  ::close(ends[1]);
  ::close(page_file);
  socket_ = ends[0];
  if (child_ < 0) {
    errno = error;
    fail("fork");
  }
}

// True once the socket is ready; false when the firmware took too long, which ends it. While a debugger is attached,
// its time is not its own: a whole deadline without one has to pass, since it may have let go just before this one ended.
bool FirmwareProcess::wait_for(short what) {
  bool was_traced = false;
  while (!socket_ready(socket_, what, deadline_s_)) {
    const bool traced = is_traced(child_);
    if (!traced && !was_traced) {
      note_end(true);
      return false;
    }
    was_traced = traced;
  }
  return true;
}

void FirmwareProcess::send(WireRequest request, const void* body, std::size_t bytes) {
  if (!end_.empty()) return;
  request.count = static_cast<std::uint32_t>(bytes);
  out_.resize(sizeof request + bytes);
  std::memcpy(out_.data(), &request, sizeof request);
  if (bytes > 0) std::memcpy(out_.data() + sizeof request, body, bytes);
  if (!wait_for(POLLOUT)) return;
  if (::send(socket_, out_.data(), out_.size(), MSG_NOSIGNAL) < 0) note_end(false);
}

std::span<const std::uint8_t> FirmwareProcess::receive() {
  if (!end_.empty() || !wait_for(POLLIN)) return {};
  const ssize_t got = ::recv(socket_, in_.data(), in_.size(), 0);
  if (got > 0) return std::span(in_).first(static_cast<std::size_t>(got));
  note_end(false);
  return {};
}

std::string FirmwareProcess::where() const {
  const auto call = static_cast<std::size_t>(page_->call);
  const char* name = call < std::size(kFirmwareCallNames) ? kFirmwareCallNames[call] : "an unknown call";
  const std::string place =
      page_->in_firmware != 0 ? std::string("in ") + name : std::string("after ") + name;
  if (page_->ticks == 0) return place + ", before the first tick";
  return fmt::format("{}, tick {} ({:.3f} s)", place, page_->ticks,
                     static_cast<double>(page_->now_ns) * 1e-9);
}

std::string FirmwareProcess::end_words(int status) const {
  if (page_->crash == CrashKind::kState) {
    if (page_->offset_bytes < 0) {
      return fmt::format("wrote or read outside its state block, {} bytes before its begin, {}",
                         -page_->offset_bytes, where());
    }
    return fmt::format(
        "wrote or read outside its state block: state_bytes is {}, the access was at byte {}, {}",
        page_->state_bytes, page_->offset_bytes, where());
  }
  if (WIFEXITED(status)) {
    if (WEXITSTATUS(status) == 127) return fmt::format("could not be started: {} is missing", kProgram);
    return fmt::format("ended its process with exit code {}, {}", WEXITSTATUS(status), where());
  }
  std::string cause = signal_words(WIFSIGNALED(status) ? WTERMSIG(status) : 0);
  if (page_->crash == CrashKind::kStack) cause = "stack overflow";
  if (page_->crash == CrashKind::kNull) {
    cause = fmt::format("SIGSEGV, a null pointer (+{} bytes)", page_->offset_bytes);
  }
  return fmt::format("crashed ({}) {}", cause, where());
}

void FirmwareProcess::note_end(bool hung) {
  int status = 0;
  ::kill(child_,
         SIGKILL);  // no matter to a process that is ending: how it ends is settled before its files close
  ::waitpid(child_, &status, 0);
  if (hung) {
    end_ = fmt::format("did not return within {:g} s of wall time and was ended, {}", deadline_s_, where());
  } else {
    end_ = end_words(status);
  }
  child_ = -1;
}

}  // namespace omnihil
