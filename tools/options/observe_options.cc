#include "tools/options/observe_options.h"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "hil/observe/image_trace.h"
#include "hil/observe/profile_text.h"
#include "hil/observe/wave_trace.h"
#include "hil/text/text_file.h"

namespace omnihil {
void add_trace_options(Verb& verb, ObserveWords& words, const std::string& when) {
  verb.add_option("--trace", words.trace,
                  "write what the image does: to a .json interrupts, functions, stack, control period "
                  "(ui.perfetto.dev, chrome://tracing), to a .vcd pins, PWM, encoders, buses, interrupts "
                  "(GTKWave, PulseView; docs/observe.md)");
  verb.add_option("--trace-last", words.last_s,
                  "keep the last so many seconds only, and write them when " + when)
      .not_negative();
  verb.add_option("--trace-filter", words.filter,
                  "only functions (.json) or signals (.vcd) whose name has one of these texts in it, such as "
                  "USART2,wheel0");
  verb.add_flag(
      "--trace-levels", words.levels,
      "of a .vcd the signals of one bit only, for PulseView and sigrok-cli (libsigrok up to 0.5.2), "
      "which stop at the first number");
}

void add_profile_options(Verb& verb, ObserveWords& words) {
  verb.add_option("--coverage", words.coverage,
                  "write which lines of the image ran, over all runs (lcov .info)");
  verb.add_option(
      "--profile", words.profile,
      "write cycles by function and caller, over all runs (callgrind), and print a table of them");
}

ImageReports::ImageReports(const ObserveWords& words, const std::string& image_file)
    : words_(words), image_file_(image_file) {
  const bool profile = !words.coverage.empty() || !words.profile.empty();
  if (!words.trace.empty() && profile)
    throw std::invalid_argument("--trace beside --coverage or --profile: one at a time");
  if (words.trace.empty() && (words.last_s > 0.0 || !words.filter.empty() || words.levels))
    throw std::invalid_argument(
        "--trace-last, --trace-filter, --trace-levels: needed: --trace FILE.json or FILE.vcd");
  const TraceOptions options{words.last_s, words.filter, words.levels};
  if (words.trace.ends_with(".json")) trace_ = std::make_shared<ImageTrace>(options);
  if (words.trace.ends_with(".vcd")) trace_ = std::make_shared<WaveTrace>(options);
  if (!words.trace.empty() && !trace_)
    throw std::invalid_argument("--trace " + words.trace + ": allowed: a name that ends in .json or .vcd");
  if (profile) profile_ = std::make_shared<ImageProfile>();
}

std::shared_ptr<ImageObserver> ImageReports::observer() const {
  if (trace_) return trace_;
  return profile_;
}

std::string ImageReports::write_trace(const std::string& name, bool failed) {
  if (!trace_) return {};
  std::string said;
  if (trace_->events() == 0) {
    said = "trace: nothing was seen: needed: an image on an emulated ARM board\n";
  } else if (words_.last_s <= 0.0 || failed) {
    std::filesystem::path path(words_.trace);
    if (!name.empty()) path.replace_filename(path.stem().string() + "-" + name + path.extension().string());
    write_text_file(path.string(), trace_->text());
    said = fmt::format("  trace {} ({} events{})\n", path.string(), trace_->events(),
                       trace_->dropped() ? ", older ones are gone: there were too many" : "");
  }
  trace_->clear();
  return said;
}

std::string ImageReports::write_profile() {
  if (!profile_) return {};
  if (profile_->functions().empty())
    return "profile: nothing was seen: needed: an image on an emulated ARM board\n";
  std::string error;
  const std::string text = read_text_file(image_file_, error);
  const std::vector<DebugLine> lines = read_lines({text.begin(), text.end()});
  if (!words_.coverage.empty() && lines.empty())
    throw std::invalid_argument("--coverage: " + image_file_ + " has no lines: compile and link it with -g");
  if (!words_.coverage.empty()) write_text_file(words_.coverage, lcov_text(*profile_, lines));
  if (words_.profile.empty()) return {};
  write_text_file(words_.profile, callgrind_text(*profile_, lines));
  return profile_table(*profile_);
}

}  // namespace omnihil
