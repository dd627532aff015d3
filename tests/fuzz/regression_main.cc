// Runs a fuzz target without a fuzzer: every file of the folders given, and of each some thousand variants that a seed
// makes (cut, bytes changed, put in, left out, two files joined). The last line says how many executions that was.
//
//   regression_packets 2000 tests/fuzz/corpus/packets      2000 variants per file
#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes running;  // NOLINT: for the handler of a crash

// Leaves the input that it was in the working folder, for the debugger and for the corpus.
void on_crash(int number) {
  std::signal(number, SIG_DFL);
  if (std::FILE* out = std::fopen("failed-input", "wb")) {
    std::fwrite(running.data(), 1, running.size(), out);
    std::fclose(out);
    std::fprintf(stderr, "its input, %zu bytes, is in ./failed-input\n", running.size());
  }
  std::raise(number);
}

void run(Bytes input) {
  running = std::move(input);
  LLVMFuzzerTestOneInput(running.data(), running.size());
}

std::vector<std::pair<std::string, Bytes>> files_of(int count, char** folders) {
  std::vector<std::pair<std::string, Bytes>> all;
  for (int i = 0; i < count; ++i) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folders[i])) {
      if (!entry.is_regular_file()) continue;
      std::ifstream file(entry.path(), std::ios::binary);
      all.emplace_back(entry.path().string(), Bytes{std::istreambuf_iterator<char>(file), {}});
    }
  }
  std::sort(all.begin(), all.end());
  return all;
}

Bytes variant(const Bytes& from, const Bytes& other, std::mt19937& random) {
  const auto below = [&](std::size_t n) { return n == 0 ? 0 : random() % n; };
  Bytes out = from;
  for (auto changes = 1 + below(4); changes > 0; --changes) {
    const auto at = static_cast<std::ptrdiff_t>(below(out.size() + 1));
    switch (below(6)) {
      case 0:
        out.resize(static_cast<std::size_t>(at));
        break;
      case 1:
        if (!out.empty()) out[below(out.size())] ^= static_cast<std::uint8_t>(1U << below(8));
        break;
      case 2:
        if (!out.empty()) out[below(out.size())] = static_cast<std::uint8_t>(below(256));
        break;
      case 3:
        out.insert(out.begin() + at, 1 + below(8), static_cast<std::uint8_t>(below(256)));
        break;
      case 4:
        out.erase(out.begin() + at,
                  out.begin() + at +
                      static_cast<std::ptrdiff_t>(below(out.size() - static_cast<std::size_t>(at) + 1)));
        break;
      default: {
        const auto first = static_cast<std::ptrdiff_t>(below(other.size() + 1));
        out.insert(
            out.begin() + at, other.begin() + first,
            other.begin() + first +
                static_cast<std::ptrdiff_t>(below(other.size() - static_cast<std::size_t>(first) + 1)));
      }
    }
  }
  return out;
}

}  // namespace

int main(int count, char** words) {
  if (count < 3) {
    std::fprintf(stderr, "VARIANTS FOLDER…\n");
    return 2;
  }
  const auto files = files_of(count - 2, words + 2);
  if (files.empty()) {
    std::fprintf(stderr, "no file in the corpus\n");
    return 1;
  }
  const int variants = std::atoi(words[1]);
  for (const int number : {SIGABRT, SIGSEGV, SIGFPE, SIGBUS, SIGILL}) std::signal(number, on_crash);
  std::mt19937 random(20);
  std::uint64_t executions = 0;
  run({});
  for (const auto& [name, bytes] : files) {
    std::fprintf(stderr, "%s\n", name.c_str());  // the last one is what a crash is about
    run(bytes);
    for (int i = 0; i < variants; ++i) run(variant(bytes, files[random() % files.size()].second, random));
    executions += 1 + static_cast<std::uint64_t>(variants);
  }
  std::printf("%llu executions of %zu files\n", static_cast<unsigned long long>(executions), files.size());
  return 0;
}
