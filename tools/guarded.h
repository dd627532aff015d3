// One place where a verb's exceptions become an exit code and a message.
//
//   result.exit_code = guarded("check", [&] { return 0; });
#pragma once
#include <cstdio>
#include <stdexcept>
#include <system_error>

#include "hil/capture/captured.h"
#include "hil/recording/recording_reader.h"
#include "hil/recording/stream_file.h"
#include "hil/text/dataset_files.h"
#include "tools/exit_codes.h"

namespace omnihil {

template <class Work>
int guarded(const char* verb, Work&& work) {
  const auto say = [verb](const std::exception& error, int code) {
    std::fflush(stdout);
    std::fprintf(stderr, "omnihil %s: %s\n", verb, error.what());
    return code;
  };
  try {
    return work();
  } catch (const BadRecording& error) {
    return say(error, kExitBadInput);
  } catch (const BadStream& error) {
    return say(error, kExitBadInput);
  } catch (const BadCapture& error) {
    return say(error, kExitBadInput);
  } catch (const FileExists& error) {
    return say(error, kExitBadInput);
  } catch (const std::invalid_argument& error) {
    return say(error, kExitBadInput);
  } catch (const std::system_error& error) {
    return say(error, kExitIo);
  } catch (const std::exception& error) {
    return say(error, kExitDiverged);
  }
}

}  // namespace omnihil
