/* Preloaded into user-mode Linux: makes it start on computers whose registers are larger than it knows (AMX, 2023 on).
 *
 * PTRACE_SETREGSET of the extended state (NT_X86_XSTATE) takes the whole of what the host's kernel keeps per
 * process, else EFAULT (Linux, arch/x86/kernel/fpu/regset.c, xstateregs_set). User-mode Linux 6.1 writes what it knows of
 * and panics: "ptrace set fp regs failed". Here what it writes is laid over the whole; states that it does
 * not know stay in their initial state, so a program within must not use them (none does without asking,
 * arch_prctl ARCH_REQ_XCOMP_PERM). */
#define _GNU_SOURCE
#include <stdarg.h>
#include <stdint.h>
#include <string.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

/* linux/ptrace.h and elf.h; their names clash with those of sys/ptrace.h. */
enum { kPeekText = 1, kPeekUser = 3, kGetRegSet = 0x4204, kSetRegSet = 0x4205, kXstate = 0x202 };
/* Header of the XSAVE area: Intel SDM vol. 1, 13.4.2. Components 0 to 9 are x87 to PKRU, those of the first 2696 bytes. */
enum { kStatesAt = 512, kKnownStates = 0x3FF, kMostBytes = 64 * 1024 };

static long set_whole(int pid, const struct iovec* known) {
  static _Alignas(64) unsigned char whole[kMostBytes];
  struct iovec all = {whole, sizeof whole};
  if (known->iov_len < kStatesAt + sizeof(uint64_t) ||
      syscall(SYS_ptrace, kGetRegSet, pid, kXstate, &all) != 0 || all.iov_len <= known->iov_len) {
    return syscall(SYS_ptrace, kSetRegSet, pid, kXstate, known);
  }
  uint64_t states;
  memcpy(whole, known->iov_base, known->iov_len);
  memcpy(&states, whole + kStatesAt, sizeof states);
  states &= kKnownStates;
  memcpy(whole + kStatesAt, &states, sizeof states);
  return syscall(SYS_ptrace, kSetRegSet, pid, kXstate, &all);
}

long ptrace(int request, ...) {
  va_list rest;
  va_start(rest, request);
  const int pid = va_arg(rest, int);
  void* const address = va_arg(rest, void*);
  void* const data = va_arg(rest, void*);
  va_end(rest);
  if (request == kSetRegSet && (long)address == kXstate) return set_whole(pid, data);
  if (request < kPeekText || request > kPeekUser) return syscall(SYS_ptrace, request, pid, address, data);
  long word = 0; /* the system call writes what the function returns */
  return syscall(SYS_ptrace, request, pid, address, &word) == 0 ? word : -1;
}
