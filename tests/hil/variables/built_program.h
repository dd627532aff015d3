// A shared object that a test compiles, loads and runs in its own process.
//
//   BuiltProgram program("-g -O2", {"names.c"});
//   program.fill();
//   program.value("wheel[2].integral");         // read through its debug information
#pragma once
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <link.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "hil/variables/variable_place.h"
#include "hil/variables/variable_value.h"

namespace omnihil {

inline std::vector<std::uint8_t> bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class BuiltProgram {
 public:
  BuiltProgram(const std::string& flags, const std::vector<std::string>& sources) {
    static int number = 0;
    path = std::filesystem::temp_directory_path() /
           ("omnihil_names_" + std::to_string(::getpid()) + "_" + std::to_string(number++) + ".so");
    std::string command = sources.front().ends_with(".cc") ? "c++" : "cc";
    command += " -shared -fPIC -w " + flags + " -o '" + path.string() + "'";
    for (const std::string& source : sources)
      command += " '" OMNIHIL_SOURCE_DIR "/tests/hil/variables/program/" + source + "'";
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
    bytes = bytes_of(path);
    std::string problem;
    if (auto info = DebugInfo::read(bytes, problem))
      names = std::make_unique<VariableNames>(info, VariableSpace{});
    EXPECT_EQ(problem, "") << flags;
  }
  ~BuiltProgram() {
    if (library_ != nullptr) ::dlclose(library_);
    std::filesystem::remove(path);
  }

  void fill() {
    library_ = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    ASSERT_NE(library_, nullptr) << ::dlerror();
    reinterpret_cast<int (*)(int)>(::dlsym(library_, "names_fill"))(3);
    link_map* map = nullptr;
    ASSERT_EQ(::dlinfo(library_, RTLD_DI_LINKMAP, &map), 0);
    base_ = map->l_addr;
  }

  // What is in this process's memory, by name; the problem where there is none.
  std::string text(const std::string& name) const {
    std::string problem;
    const auto place = names->find_value(name, problem);
    return place ? text_of_value(names->info().type(place->type), *place, raw(*place)) : problem;
  }
  double number(const std::string& name) const {
    std::string problem;
    const auto place = names->find_value(name, problem);
    EXPECT_TRUE(place) << name << ": " << problem;
    return place ? number_of_value(names->info().type(place->type), *place, raw(*place)) : 0.0;
  }
  std::string set(const std::string& name, const std::string& value) const {
    std::string problem;
    const auto place = names->find_value(name, problem);
    if (!place) return problem;
    std::vector<std::uint8_t> bytes_now = raw(*place);
    problem = value_bytes(value, names->info().type(place->type), *place, bytes_now);
    if (problem.empty()) std::memcpy(address(*place), bytes_now.data(), bytes_now.size());
    return problem;
  }

  std::filesystem::path path;
  std::vector<std::uint8_t> bytes;
  std::unique_ptr<VariableNames> names;

 private:
  std::uint8_t* address(const VariablePlace& place) const {
    return reinterpret_cast<std::uint8_t*>(base_ + place.piece.address);
  }
  std::vector<std::uint8_t> raw(const VariablePlace& place) const {
    if (!place.constant.empty()) return place.constant;
    return {address(place), address(place) + place.piece.bytes};
  }

  void* library_ = nullptr;
  std::uintptr_t base_ = 0;
};

}  // namespace omnihil
