// Writes the report of the made-up diagnosis to the file named: what the browser tests open.
#include <cstdio>
#include <fstream>

#include "hil/report/report_html.h"
#include "tests/hil/report/sample.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: report_page FILE\n");
    return 2;
  }
  std::ofstream file(argv[1], std::ios::binary);
  file << omnihil::report_html(omnihil::sample_input());
  file.close();
  return file ? 0 : 3;
}
