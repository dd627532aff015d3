// How a process that was run as a helper ended, in words.
#pragma once
#include <string>

namespace omnihil {

std::string signal_words(int signal);

}  // namespace omnihil
