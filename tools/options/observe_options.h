// The options with which a verb lets its user look at what an image does: traces, coverage, profile.
//
//   add_trace_options(verb, words, "a check fails");  // --trace, --trace-last, --trace-filter
//   add_profile_options(verb, words);                // --coverage, --profile
//   ImageReports reports(words, firmware.file);      // std::invalid_argument
//   firmware.observer = reports.observer();
//   …  reports.write_trace("step", failed);  reports.write_profile();
#pragma once
#include <memory>
#include <string>

#include "hil/observe/image_profile.h"
#include "hil/observe/trace_observer.h"
#include "tools/command_line.h"

namespace omnihil {

struct ObserveWords {
  std::string trace, filter, coverage, profile;
  bool levels = false;
  double last_s = 0.0;
};

// `when`: the last stretch is written.
void add_trace_options(Verb& verb, ObserveWords& words, const std::string& when);
void add_profile_options(Verb& verb, ObserveWords& words);

class ImageReports {
 public:
  ImageReports(const ObserveWords& words, const std::string& image_file);
  std::shared_ptr<ImageObserver> observer() const;  // null: nothing is asked for
  // Of the run that is over. With --trace-last only when it failed. `name` goes into the file's, where it is not empty.
  // What was written, for people; empty: nothing.
  std::string write_trace(const std::string& name, bool failed);
  // Of all runs; the table of the profile.
  std::string write_profile();

 private:
  ObserveWords words_;
  std::string image_file_;
  std::shared_ptr<TraceObserver> trace_;
  std::shared_ptr<ImageProfile> profile_;
};

}  // namespace omnihil
