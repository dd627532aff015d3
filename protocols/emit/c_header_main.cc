// emit_c_header FORMAT_ID OUTPUT_FILE: writes the C header of one radio format.
#include <cstdio>
#include <fstream>

#include "protocols/emit/emit.h"

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: emit_c_header FORMAT_ID OUTPUT_FILE\n");
    return 2;
  }
  const omnihil::RadioFormat* format = omnihil::find_radio_format(argv[1]);
  if (format == nullptr) {
    std::fprintf(stderr, "emit_c_header: no radio format '%s'\n", argv[1]);
    return 2;
  }
  std::ofstream file(argv[2], std::ios::binary);
  file << omnihil::emit_c_header(*format);
  file.close();
  if (!file) {
    std::fprintf(stderr, "emit_c_header: cannot write '%s'\n", argv[2]);
    return 3;
  }
  return 0;
}
