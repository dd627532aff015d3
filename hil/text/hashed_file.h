// A file by its name and what was in it, to tell later whether another one is the same.
//
//   HashedFile file = hash_file("build/libfw.so");   // {"libfw.so", "9f86d0…"}
#pragma once
#include <string>

namespace omnihil {

struct HashedFile {
  std::string name;    // without its folders
  std::string sha256;  // 64 hexadecimal digits; empty: no file, a board on the desk for one

  bool operator==(const HashedFile&) const = default;
};

// Throws std::system_error with the path when it cannot be read.
HashedFile hash_file(const std::string& path);

}  // namespace omnihil
