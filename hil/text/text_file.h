// A whole file as text, or why it cannot be had.
//
//   std::string error;
//   std::string text = read_text_file("bench/dataset.toml", error);      // error: "no such file"
#pragma once
#include <filesystem>
#include <string>

namespace omnihil {

// Ordinary files only: a device or a pipe is refused, since it may never end.
std::string read_text_file(const std::filesystem::path& path, std::string& error);

}  // namespace omnihil
