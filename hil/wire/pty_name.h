// The name a user gives the device: a symbolic link to the pty's slave, such as ./dongle -> /dev/pts/5.
//
//   PtyName name;
//   std::string problem = name.claim("./dongle", "/dev/pts/5");  // empty: the link is there
//   name.point_to("/dev/pts/7");                                // the device behind it changed
//   name.release();                                             // gone; also by the destructor
//
// A name is taken only if nothing is there, or a link that leads nowhere (a bench that was killed left it)
// or to the very pty it shall point to. A file, a folder, a link to something alive is never touched: the
// problem says what is in the way. On release the link is removed only if it is still ours.
#pragma once
#include <string>

namespace omnihil {

class PtyName {
 public:
  PtyName() = default;
  ~PtyName() { release(); }
  PtyName(const PtyName&) = delete;
  PtyName& operator=(const PtyName&) = delete;

  std::string claim(const std::string& path, const std::string& target);
  bool point_to(const std::string& target);
  void release();
  const std::string& path() const { return path_; }

 private:
  bool still_ours() const;

  std::string path_;  // absolute, so that a later change of folder does not matter; empty: not held
  std::string target_;
};

}  // namespace omnihil
