// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/temporary_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstring>
#include <string>
#include <system_error>

#include <eigencrust/io.h>

#include "io/system_call.h"

namespace eigencrust {
namespace io {
namespace {

namespace fs = std::filesystem;

// A signal handler can reach nothing but what has static storage.
struct Slot {
  enum State : int { free, taken, named };
  std::atomic<int> state{free};
  std::array<char, 4096> path{};
};
std::array<Slot, 16> slots; // more files than that are not written side by side; what finds none is swept later

int register_name(const std::string& path) {
  if (path.size() >= slots[0].path.size()) return -1;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    int expected = Slot::free;
    if (!slots[i].state.compare_exchange_strong(expected, Slot::taken)) continue;
    std::memcpy(slots[i].path.data(), path.c_str(), path.size() + 1);
    slots[i].state = Slot::named;
    return static_cast<int>(i);
  }
  return -1;
}

void release_name(int slot) {
  if (slot >= 0) slots[static_cast<std::size_t>(slot)].state = Slot::free;
}

/// No two runs on one host have a name in common, hardly any on two hosts; creation refuses what exists.
std::string temporary_name(const fs::path& target) {
  static std::atomic<unsigned> count{0};
  constexpr std::size_t longest = 180; // file systems allow 255 bytes
  const auto now = std::chrono::steady_clock::now().time_since_epoch().count();
  return '.' + target.filename().string().substr(0, longest) + '.' + std::to_string(getpid()) + '.' +
         std::to_string(count++) + '.' + std::to_string(now % 1'000'000'000) + temporary_suffix;
}

/// What runs that were killed have left in the folder. Where locks cannot be had, nothing is removed.
void remove_stale(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator entry(folder.empty() ? fs::path(".") : folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (!name.starts_with('.') || !name.ends_with(temporary_suffix)) continue;
    const int file = open(entry->path().c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (file < 0) continue;
    struct stat status {};
    if (fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_uid == geteuid() &&
        flock(file, LOCK_EX | LOCK_NB) == 0)
      unlink(entry->path().c_str());
    close(file);
  }
}

/// Gives the file the owner and the permissions of the one it replaces.
void keep_owner_and_mode(int file, const struct stat& replaced) {
  mode_t mode = replaced.st_mode & 0777;
  struct stat own {};
  if (fstat(file, &own) == 0 && (own.st_uid != replaced.st_uid || own.st_gid != replaced.st_gid) &&
      fchown(file, replaced.st_uid, replaced.st_gid) != 0 && fchown(file, static_cast<uid_t>(-1), replaced.st_gid) != 0)
    mode &= ~static_cast<mode_t>(070);    // what its group was allowed is not for another group
  if (fchmod(file, mode) != 0) errno = 0; // file systems without permissions
}

} // namespace

bool TemporaryFile::create(mode_t mode) {
  constexpr int attempts = 100;
  for (int attempt = 0; attempt < attempts; ++attempt) {
    path_ = folder_ / temporary_name(target_);
    slot_ = register_name(path_.string());
    // With its final mode from the start: nobody may look into it who may not look into the finished file.
    descriptor_ = uninterrupted([&] { return open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, mode); });
    if (descriptor_ >= 0 && lock()) return true;
    const int code = errno;
    if (descriptor_ >= 0) close(descriptor_);
    const bool lost = descriptor_ >= 0 || code == EEXIST;
    descriptor_ = -1;
    release_name(slot_);
    slot_ = -1;
    errno = code;
    if (!lost) return false;
  }
  errno = EEXIST;
  return false;
}

/// Another run may have taken the file for a stale one before it was locked.
bool TemporaryFile::lock() const {
  if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) return false;
  struct stat status {};
  return fstat(descriptor_, &status) != 0 || status.st_nlink > 0;
}

TemporaryFile::TemporaryFile(fs::path target, const struct stat* replaced)
    : target_(std::move(target)), folder_(target_.parent_path()) {
  remove_stale(folder_);
  // With 0666 the process's umask decides, as for any file.
  if (!create(replaced == nullptr ? mode_t{0666} : replaced->st_mode & mode_t{0777}))
    fail(target_, "cannot create a file in this folder", errno, "check that the folder exists and is writable");
  if (replaced != nullptr) keep_owner_and_mode(descriptor_, *replaced);
}

TemporaryFile::~TemporaryFile() {
  if (!in_place_) unlink(path_.c_str());
  release_name(slot_);
  if (descriptor_ >= 0) close(descriptor_); // the lock goes with it
}

void TemporaryFile::put_in_place() {
  if (rename(path_.c_str(), target_.c_str()) != 0)
    fail(target_, "cannot put the finished file in its place", errno, "check the permissions of the folder");
  in_place_ = true;
  // So that the rename survives a power failure; where that is not possible, nothing is lost before one.
  const int folder = open(folder_.empty() ? "." : folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  fsync(folder);
  close(folder);
}

} // namespace io

void remove_temporaries() noexcept {
  for (io::Slot& slot : io::slots)
    if (slot.state == io::Slot::named) unlink(slot.path.data());
}

} // namespace eigencrust
