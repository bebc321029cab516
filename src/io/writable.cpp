// SPDX-License-Identifier: GPL-3.0-or-later
// Can a file be written there? Asked before the work, which may take hours.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <system_error>

#include <eigencrust/io.h>

#include "io/system_call.h"

namespace eigencrust {
namespace {

namespace fs = std::filesystem;

using io::fail;

/// A file without a name, or with one for a moment where the file system knows no others.
int open_probe(const fs::path& folder) {
  int descriptor = open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0600);
  if (descriptor >= 0 || (errno != EOPNOTSUPP && errno != EISDIR && errno != ENOENT && errno != EINVAL))
    return descriptor;
  std::string name = (folder / ".eigencrust.XXXXXX").string();
  descriptor = mkstemp(name.data());
  if (descriptor >= 0) unlink(name.c_str());
  return descriptor;
}

/// Makes a file there and writes a block, so that a full disk and a spent quota show.
void probe_folder(const fs::path& path, const fs::path& folder) {
  const int descriptor = open_probe(folder);
  if (descriptor < 0)
    fail(path, "cannot create a file in this folder", errno, "check that the folder exists and is writable");
  constexpr std::array<char, 4096> block{};
  int code = 0;
  // A limit on the size of files, which would end the process, is not reached by a block that is asked for first.
  if (const int refused = posix_fallocate(descriptor, 0, block.size()); refused == ENOSPC || refused == EDQUOT)
    code = refused;
  if (code == 0 && write(descriptor, block.data(), block.size()) < 0 && (errno == ENOSPC || errno == EDQUOT))
    code = errno;
  close(descriptor);
  if (code != 0) fail(path, "cannot write a file in this folder", code, "make room, or name another folder");
}

} // namespace

void require_writable(const std::filesystem::path& path) {
  if (!path.has_filename()) fail(path, "the name of a file is missing", 0, "name the file to be written");
  struct stat status {};
  if (stat(path.c_str(), &status) == 0) {
    if (S_ISDIR(status.st_mode)) fail(path, "this is a folder", 0, "name a file to be written");
    if (access(path.c_str(), W_OK) != 0) fail(path, "the file is write-protected", errno, "write to another file");
    if (!S_ISREG(status.st_mode)) return; // devices and pipes are written through
  }
  const fs::path target = follow_links(path);
  constexpr std::size_t longest_name = 255; // of all file systems in use
  if (target.filename().native().size() > longest_name)
    fail(path, "the name is longer than file systems allow", ENAMETOOLONG, "choose a shorter one");
  probe_folder(path, target.has_parent_path() ? target.parent_path() : fs::path("."));
}

} // namespace eigencrust
