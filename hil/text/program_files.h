// Where the files are that come with the running program: one layout, installed and in the build tree alike.
//
//   bin/omnihil                    the program (build tree: tools/omnihil; tests and benches beside that folder)
//   libexec/omnihil/NAME           helper programs that it starts (build tree: a link to tools/)
//   share/omnihil/NAME             models, boards, examples (build tree: links to the sources)
//
//   load_model("omni_default", {data_folder("models")});
//   helper_program("omnihil-avr");          // "/usr/libexec/omnihil/omnihil-avr"
//
// Both are found from the program's own place, so that what was installed may be moved as a whole.
#pragma once
#include <string>

namespace omnihil {

// share/omnihil/NAME without links in its path; the path where it was looked for when it is not there.
std::string data_folder(const std::string& name);

// libexec/omnihil/NAME, else NAME beside the program, else NAME alone: by the search path.
std::string helper_program(const std::string& name);

}  // namespace omnihil
