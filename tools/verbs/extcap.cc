// omnihil extcap: Wireshark's questions to a program that captures for it, and the capture of a running bench.
// Source: Wireshark developer's guide, "Extcap"; doc/extcap.adoc.
#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>

#include "hil/serve/extcap_capture.h"
#include "tools/command_line.h"
#include "tools/exit_codes.h"
#include "tools/verbs/verbs.h"

namespace omnihil {
namespace {

constexpr const char* kSocket = "/tmp/omnihil-capture";
constexpr const char* kInterface = "omnihil";

struct Words {
  bool interfaces = false, dlts = false, config = false, capture = false;
  std::string interface, version, filter, fifo, reload;
  std::string socket = kSocket;
};

int fail(const std::string& what, int exit_code) {
  std::fprintf(stderr, "omnihil extcap: %s\n", what.c_str());
  return exit_code;
}

int run(const Words& w) {
  if (w.interfaces) {
    fmt::print("extcap {{version=1.0}}{{display=omnihil}}\n");
    fmt::print("interface {{value={}}}{{display=omnihil: a running bench}}\n", kInterface);
    return kExitOk;
  }
  if (!w.interface.empty() && w.interface != kInterface)
    return fail(fmt::format("unknown interface {}; known: {}", w.interface, kInterface), kExitBadInput);
  if (w.dlts) {
    fmt::print("dlt {{number=147}}{{name=USER0}}{{display=Packets of a radio format}}\n");
    return kExitOk;
  }
  if (w.config) {
    fmt::print(
        "arg {{number=0}}{{call=--socket}}{{display=Socket}}{{tooltip=as serve --capture names it}}"
        "{{type=string}}{{default={}}}\n",
        kSocket);
    return kExitOk;
  }
  if (!w.capture) return fail("nothing asked; Wireshark calls this", kExitBadInput);
  if (w.fifo.empty()) return fail("--capture needs --fifo", kExitBadInput);
  switch (copy_capture(w.socket, w.fifo)) {
    case ExtcapEnd::kNoPipe:
      return fail(w.fifo + ": " + std::strerror(errno), kExitIo);
    case ExtcapEnd::kNoSocket:
      return fail(w.socket + ": " + std::strerror(errno), kExitIo);
    case ExtcapEnd::kDone:
      break;
  }
  return kExitOk;
}

}  // namespace

void add_verb_extcap(Verb& program, VerbResult& result) {
  auto words = std::make_shared<Words>();
  Words& w = *words;
  Verb verb = program.add_subcommand("extcap", "captures a running bench for Wireshark, which calls it");
  verb.add_flag("--extcap-interfaces", w.interfaces, "says what can be captured");
  verb.add_option("--extcap-interface", w.interface, "which one is meant: omnihil");
  verb.add_flag("--extcap-dlts", w.dlts, "says the link type: USER0, as convert --to pcap");
  verb.add_flag("--extcap-config", w.config, "says what can be set");
  verb.add_option("--extcap-version", w.version, "Wireshark's version; of no effect");
  verb.add_option("--extcap-capture-filter", w.filter, "of no effect: packets are not chosen here");
  verb.add_option("--extcap-reload-option", w.reload, "of no effect");
  verb.add_flag("--capture", w.capture, "captures until the bench ends");
  verb.add_option("--fifo", w.fifo, "the pipe that Wireshark reads");
  verb.add_option("--socket", w.socket, "what serve --capture named").capture_default_str();
  verb.footer(
      "Put examples/wireshark/omnihil-extcap into Wireshark's extcap folder (Help, About, Folders) and "
      "start\n"
      "  omnihil serve --capture /tmp/omnihil-capture");
  verb.callback([words, &result] { result.exit_code = run(*words); });
}

}  // namespace omnihil
