// SPDX-License-Identifier: GPL-3.0-or-later
#include "standard_streams.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include <eigencrust/error.h>

#include "command.h"

namespace eigencrust::cli {
namespace {

[[noreturn]] void fail(const std::string& place, const std::string& cause, const std::string& remedy) {
  throw Error(ErrorKind::input, place, cause + ": " + std::generic_category().message(errno), remedy);
}

/// A file without a name: nothing is left of it whatever happens.
int open_nameless() {
  std::error_code ignored;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(ignored);
  int descriptor = open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (descriptor >= 0) return descriptor;
  std::string name = (folder / "eigencrust.XXXXXX").string(); // file systems that know no such files
  descriptor = mkstemp(name.data());
  if (descriptor >= 0) unlink(name.c_str());
  return descriptor;
}

[[noreturn]] void fail_cancelled() {
  throw Error(ErrorKind::cancelled, "reading", "cancelled", "start again to finish");
}

/// Waits until somebody writes into a pipe; a signal ends that.
int open_patiently(const std::string& path) {
  int descriptor = -1;
  do {
    if (interrupted()) fail_cancelled();
    descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  } while (descriptor < 0 && errno == EINTR);
  return descriptor;
}

void copy_all(int from, int to, const std::string& place) {
  std::array<char, 1 << 16> buffer{};
  while (true) {
    constexpr int patience = 100; // milliseconds until somebody who gave up is noticed
    pollfd ready{from, POLLIN, 0};
    if (interrupted()) fail_cancelled();
    if (poll(&ready, 1, patience) == 0) continue;
    const ssize_t got = read(from, buffer.data(), buffer.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(place, "it cannot be read", "check what writes to it");
    if (got == 0) return;
    for (ssize_t done = 0; done < got;) {
      const ssize_t put = write(to, buffer.data() + done, static_cast<std::size_t>(got - done));
      if (put < 0 && errno == EINTR) continue;
      if (put < 0) fail(place, "there is no room for a copy", "make room, or set TMPDIR to a folder with more");
      done += put;
    }
  }
}

} // namespace

bool is_standard_output(const std::string& path) {
  return path == "-" || path == "/dev/stdout" || path == "/dev/fd/1" || path == "/proc/self/fd/1";
}

ReadableFile::ReadableFile(const std::string& path) : given_(path == "-" ? "standard input" : path), path_(path) {
  struct stat status {};
  const bool is_pipe = stat(path.c_str(), &status) == 0 && (S_ISFIFO(status.st_mode) || S_ISSOCK(status.st_mode));
  if (path != "-" && !is_pipe) return;
  const int from = path == "-" ? dup(STDIN_FILENO) : open_patiently(path);
  if (from < 0) fail(given_, "it cannot be opened", "check what writes to it");
  descriptor_ = open_nameless();
  if (descriptor_ < 0) {
    close(from);
    fail(given_, "there is no folder for a copy", "set TMPDIR to a folder that can be written");
  }
  path_ = "/proc/self/fd/" + std::to_string(descriptor_);
  try {
    copy_all(from, descriptor_, given_);
  } catch (...) {
    close(from);
    close(descriptor_);
    throw;
  }
  close(from);
}

ReadableFile::~ReadableFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

void ReadableFile::rename_place_and_throw() const {
  try {
    throw;
  } catch (const Error& error) {
    std::string place = error.place();
    if (place.starts_with(path_)) place.replace(0, path_.size(), given_);
    throw Error(error.kind(), place, error.cause(), error.remedy());
  }
}

} // namespace eigencrust::cli
