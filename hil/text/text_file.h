// A whole file as text, or why it cannot be had; text put into a file.
//
//   std::string error;
//   std::string text = read_text_file("bench/dataset.toml", error);      // error: "no such file"
//   write_text_file("report.xml", text);
//   append_text_file("history.jsonl", text);
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace omnihil {

// Ordinary files only: a device or a pipe is refused, since it may never end.
std::string read_text_file(const std::filesystem::path& path, std::string& error);

// Where it cannot be written: throw std::system_error with the file's name.
void write_text_file(const std::filesystem::path& path, std::string_view text);
void append_text_file(const std::filesystem::path& path, std::string_view text);

}  // namespace omnihil
