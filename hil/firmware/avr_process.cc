#include "hil/firmware/avr_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <stdexcept>
#include <system_error>

#include "hil/firmware/child_socket.h"
#include "hil/firmware/signal_words.h"
#include "hil/text/program_files.h"

namespace omnihil {
namespace {
constexpr const char* kProgram = "omnihil-avr";
constexpr const char* kGreeting = "omnihil-avr 2";
}  // namespace

AvrProcess::AvrProcess(double deadline_s) : deadline_s_(deadline_s) {
  start();
  std::string line;
  if (receive(line) && line == kGreeting) return;
  throw std::runtime_error(
      end_.empty() ? fmt::format("{} speaks \"{}\", needed: \"{}\"", kProgram, line.substr(0, 60), kGreeting)
                   : fmt::format("{} {}", kProgram, end_));
}

AvrProcess::~AvrProcess() {
  if (socket_ >= 0) ::close(socket_);
  if (child_ > 0) {
    ::kill(child_, SIGKILL);
    ::waitpid(child_, nullptr, 0);
  }
}

void AvrProcess::start() {
  const std::string path = helper_program(kProgram);
  const char* words[] = {path.c_str(), nullptr};
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
    throw std::system_error(errno, std::generic_category(), "omnihil-avr: socket pair");
  }
  child_ = ::fork();
  if (child_ == 0) {  // only what is allowed between fork and exec
    ::dup2(ends[1], STDIN_FILENO);
    ::dup2(ends[1], STDOUT_FILENO);
    ::execvp(path.c_str(), const_cast<char* const*>(words));
    ::_exit(127);
  }
  const int error = errno;
  ::close(ends[1]);
  socket_ = ends[0];
  if (child_ < 0) throw std::system_error(error, std::generic_category(), "omnihil-avr: fork");
}

// True once the socket is ready; false when the program took too long, which ends it.
bool AvrProcess::wait_for(short what) {
  if (socket_ready(socket_, what, deadline_s_)) return true;
  note_end(true);
  return false;
}

void AvrProcess::send(const std::string& line) {
  const std::string text = line + "\n";
  for (std::size_t sent = 0; end_.empty() && sent < text.size();) {
    if (!wait_for(POLLOUT)) return;
    const ssize_t n = ::send(socket_, text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
    if (n < 0 && errno != EINTR) return note_end(false);
    if (n > 0) sent += static_cast<std::size_t>(n);
  }
}

bool AvrProcess::receive(std::string& line) {
  for (;;) {
    if (const std::size_t at = in_.find('\n'); at != std::string::npos) {
      line = in_.substr(0, at);
      in_.erase(0, at + 1);
      return true;
    }
    if (!end_.empty() || !wait_for(POLLIN)) return false;
    char part[4096];
    const ssize_t got = ::recv(socket_, part, sizeof part, 0);
    if (got > 0) {
      in_.append(part, static_cast<std::size_t>(got));
    } else if (got == 0 || errno != EINTR) {
      note_end(false);
    }
  }
}

void AvrProcess::note_end(bool hung) {
  int status = 0;
  ::kill(child_, SIGKILL);  // no matter to a process that is ending: how it ends is settled already
  ::waitpid(child_, &status, 0);
  child_ = -1;
  if (hung) {
    end_ = fmt::format("did not answer within {:g} s of wall time and was ended", deadline_s_);
  } else if (WIFEXITED(status) && WEXITSTATUS(status) == 127) {
    end_ = "is not there: it is built where simavr is installed (docs/mcu-avr.md)";
  } else if (WIFEXITED(status)) {
    end_ = fmt::format("ended with exit code {}", WEXITSTATUS(status));
  } else {
    end_ = fmt::format("crashed ({})", signal_words(WIFSIGNALED(status) ? WTERMSIG(status) : 0));
  }
}

}  // namespace omnihil
