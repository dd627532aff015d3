#include "hil/debugger/gdb_moments.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <type_traits>

namespace omnihil {
namespace {

constexpr std::int64_t kLookEvery_ns = 50'000'000;  // of wall time, for signals

// Values and lists of plain bytes, one after the other: both ends are this program.
struct Letter {
  std::vector<std::uint8_t> bytes;
  std::size_t at = 0;

  template <class T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto* first = reinterpret_cast<const std::uint8_t*>(&value);
    bytes.insert(bytes.end(), first, first + sizeof value);
  }
  template <class List>
  void put_list(const List& list) {
    put(static_cast<std::uint64_t>(list.size()));
    for (const auto& value : list) put(value);
  }
  template <class T>
  T take() {
    T value{};
    std::memcpy(&value, bytes.data() + at, sizeof value);
    at += sizeof value;
    return value;
  }
  template <class List>
  List take_list() {
    List list(static_cast<std::size_t>(take<std::uint64_t>()), typename List::value_type{});
    for (auto& value : list) value = take<typename List::value_type>();
    return list;
  }
  void put_talk(const GdbTalk& talk) {
    put(talk.acks);
    put(talk.chosen);
    put_list(talk.breakpoints);
    put_list(talk.watches);
  }
  GdbTalk take_talk() {
    GdbTalk talk;
    talk.acks = take<bool>();
    talk.chosen = take<std::uint64_t>();
    talk.breakpoints = take_list<std::vector<std::uint32_t>>();
    talk.watches = take_list<std::vector<mcu::AccessWatch>>();
    return talk;
  }
};

bool move_all(int fd, std::uint8_t* bytes, std::size_t size, bool write) {
  while (size > 0) {
    const ssize_t n = write ? ::send(fd, bytes, size, MSG_NOSIGNAL) : ::recv(fd, bytes, size, 0);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    bytes += n;
    size -= static_cast<std::size_t>(n);
  }
  return true;
}

bool send_letter(int fd, Letter& letter) {
  std::uint64_t size = letter.bytes.size();
  return move_all(fd, reinterpret_cast<std::uint8_t*>(&size), sizeof size, true) &&
         move_all(fd, letter.bytes.data(), letter.bytes.size(), true);
}

bool receive_letter(int fd, Letter& letter) {
  std::uint64_t size = 0;
  if (!move_all(fd, reinterpret_cast<std::uint8_t*>(&size), sizeof size, false)) return false;
  letter.bytes.resize(size);
  return move_all(fd, letter.bytes.data(), letter.bytes.size(), false);
}

// Ends with `parent`, whatever becomes of it.
void end_with(pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(0);
}

}  // namespace

std::optional<PastOrder> GdbMoments::keep(const mcu::DebugUnit* of, std::uint64_t instructions) {
  while (kept_.size() >= kMost) drop_oldest();
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) return std::nullopt;
  const pid_t parent = ::getpid(), process = ::fork();
  if (process != 0) {
    Descriptor here(ends[0]);
    ::close(ends[1]);
    if (process > 0) kept_.push_back({of, instructions, process, std::move(here)});
    if (process < 0) forget();  // what is kept no longer leads here
    return std::nullopt;
  }
  end_with(parent);
  ::close(ends[0]);
  for (Moment& moment : kept_)
    moment.wire.reset();  // another's wires would keep those waiting when we are gone
  kept_.clear();
  return wait_for_orders(ends[1]);
}

// In the moment's process. Comes back in copies of it alone.
std::optional<PastOrder> GdbMoments::wait_for_orders(int fd) {
  for (;;) {
    Letter letter;
    if (!receive_letter(fd, letter)) ::_exit(0);
    const pid_t moment = ::getpid(), runner = ::fork();
    if (runner == 0) {
      end_with(moment);
      PastOrder order;
      order.plain = letter.take<PastOrder::Plain>();
      order.reply = letter.take_list<std::string>();
      order.talk = letter.take_talk();
      to_asker_ = fd;
      return order;
    }
    int status = 0;
    while (runner > 0 && ::waitpid(runner, &status, 0) < 0 && errno == EINTR) {
    }
    if (runner < 0 || !WIFEXITED(status) || WEXITSTATUS(status) != 0) ::_exit(1);
  }
}

void GdbMoments::drop_oldest() {
  const pid_t process = kept_.front().process;
  kept_.pop_front();
  ::kill(process, SIGKILL);
  while (::waitpid(process, nullptr, 0) < 0 && errno == EINTR) {
  }
}

void GdbMoments::forget() {
  while (!kept_.empty()) drop_oldest();
}

std::vector<std::size_t> GdbMoments::of(const mcu::DebugUnit* unit) const {
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    if (kept_[i].unit == unit) all.push_back(i);
  }
  return all;
}

std::optional<PastReport> GdbMoments::ask(std::size_t moment, const PastOrder& order,
                                          const std::function<bool()>& asked_to_end) {
  const int fd = kept_[moment].wire.get();
  Letter letter;
  letter.put(order.plain);
  letter.put_list(order.reply);
  letter.put_talk(order.talk);
  if (!send_letter(fd, letter)) return std::nullopt;
  std::uint8_t first = 0;
  while (::recv(fd, &first, 1, MSG_PEEK | MSG_DONTWAIT) < 0 && (errno == EAGAIN || errno == EINTR)) {
    if (asked_to_end()) return std::nullopt;
    static_cast<void>(wait_for(fd, kLookEvery_ns, false));
  }
  Letter answer;
  if (!receive_letter(fd, answer)) return std::nullopt;
  PastReport report;
  report.plain = answer.take<PastReport::Plain>();
  report.talk = answer.take_talk();
  return report;
}

void GdbMoments::mute_all_but(int fd) const {
  const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  DIR* const all = ::opendir("/proc/self/fd");
  if (nowhere < 0 || all == nullptr) ::_exit(1);
  std::vector<int> others;
  while (const dirent* entry = ::readdir(all)) {
    const int other = std::atoi(entry->d_name);
    if (entry->d_name[0] != '.' && other != fd && other != to_asker_ && other != nowhere &&
        other != ::dirfd(all))
      others.push_back(other);
  }
  ::closedir(all);
  for (const int other : others) ::dup2(nowhere, other);
}

void GdbMoments::report(const PastReport& report) const {
  Letter letter;
  letter.put(report.plain);
  letter.put_talk(report.talk);
  ::_exit(send_letter(to_asker_, letter) ? 0 : 1);
}

}  // namespace omnihil
