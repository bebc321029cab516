// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <locale>
#include <random>
#include <streambuf>
#include <system_error>

#include <eigencrust/error.h>
#include <eigencrust/io.h>

#include "io/link_target.h"

namespace eigencrust {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& cause, int code, const std::string& remedy) {
  throw Error(ErrorKind::input, path.string(), code == 0 ? cause : cause + ": " + std::generic_category().message(code),
              remedy);
}

/// A stream buffer on a file descriptor that keeps the first error.
class DescriptorBuffer : public std::streambuf {
 public:
  explicit DescriptorBuffer(int descriptor) : descriptor_(descriptor) {
    setp(buffer_.data(), buffer_.data() + buffer_.size());
  }
  [[nodiscard]] int error() const { return error_; }

 protected:
  int_type overflow(int_type c) override {
    if (sync() != 0) return traits_type::eof();
    if (!traits_type::eq_int_type(c, traits_type::eof())) sputc(traits_type::to_char_type(c));
    return traits_type::not_eof(c);
  }
  int sync() override {
    const bool good = write_all(pbase(), static_cast<std::size_t>(pptr() - pbase()));
    setp(buffer_.data(), buffer_.data() + buffer_.size());
    return good ? 0 : -1;
  }
  std::streamsize xsputn(const char* text, std::streamsize size) override {
    if (size < static_cast<std::streamsize>(buffer_.size())) return std::streambuf::xsputn(text, size);
    return sync() == 0 && write_all(text, static_cast<std::size_t>(size)) ? size : 0;
  }

 private:
  bool write_all(const char* text, std::size_t size) {
    while (size > 0 && error_ == 0) {
      const ssize_t written = write(descriptor_, text, size);
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) {
        error_ = errno;
      } else {
        text += written;
        size -= static_cast<std::size_t>(written);
      }
    }
    return error_ == 0;
  }

  int descriptor_;
  int error_ = 0;
  std::array<char, 1 << 16> buffer_{};
};

/// An open file; removed at the end of the scope unless kept.
class OutputFile {
 public:
  OutputFile(fs::path path, int descriptor, bool temporary)
      : path_(std::move(path)), descriptor_(descriptor), temporary_(temporary) {}
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile() {
    if (descriptor_ >= 0) close(descriptor_);
    if (temporary_) unlink(path_.c_str());
  }

  /// Lets `write` fill the file and makes sure that it arrived. \param target for messages
  void fill(const std::function<void(std::ostream&)>& write, const fs::path& target) {
    DescriptorBuffer buffer(descriptor_);
    std::ostream out(&buffer);
    out.imbue(std::locale::classic());
    write(out);
    out.flush();
    if (buffer.error() != 0 || !out)
      fail(target, "cannot write the file", buffer.error(), "check the space on the disk");
    // Pipes and some file systems know no fsync.
    if (fsync(descriptor_) != 0 && errno != EINVAL && errno != ENOTSUP && errno != EROFS)
      fail(target, "cannot write the file", errno, "check the space on the disk");
    const int closing = std::exchange(descriptor_, -1);
    if (close(closing) != 0 && errno != EINTR)
      fail(target, "cannot write the file", errno, "check the space on the disk");
  }
  void rename_to(const fs::path& target) {
    if (rename(path_.c_str(), target.c_str()) != 0)
      fail(target, "cannot put the finished file in its place", errno, "check the permissions of the folder");
    temporary_ = false;
  }
  [[nodiscard]] int descriptor() const { return descriptor_; }

 private:
  fs::path path_;
  int descriptor_;
  bool temporary_;
};

/// Devices, pipes and what stands for a descriptor of the process cannot be replaced by another file.
bool is_special(const fs::path& path, const struct stat& status) {
  const std::string name = path.string();
  return !S_ISREG(status.st_mode) || name.starts_with("/dev/") || name.starts_with("/proc/");
}

std::string temporary_name(const fs::path& target) {
  constexpr std::size_t longest = 180; // file systems allow 255 bytes
  std::random_device random;
  return '.' + target.filename().string().substr(0, longest) + '.' + std::to_string(getpid()) + '.' +
         std::to_string(random()) + ".tmp";
}

/// \param mode of the file that will be replaced, or -1
OutputFile create_beside(const fs::path& target, int mode) {
  const fs::path folder = target.parent_path();
  for (int attempt = 0; attempt < 100; ++attempt) {
    fs::path path = folder / temporary_name(target);
    // With 0666 the process's umask decides, as for any file.
    const int descriptor = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor < 0 && errno == EEXIST) continue;
    if (descriptor < 0)
      fail(target, "cannot create a file in this folder", errno, "check that the folder exists and is writable");
    // Whoever overwrites a file expects it to stay as readable as it was.
    if (mode >= 0 && fchmod(descriptor, static_cast<mode_t>(mode) & 07777) != 0) errno = 0;
    return {std::move(path), descriptor, true};
  }
  fail(target, "cannot find a name for the temporary file", 0, "clean up the folder");
}

void write_through(const fs::path& path, const std::function<void(std::ostream&)>& write) {
  // Standard output is written where it stands: opened anew, a file behind it would be written from its beginning, and
  // a socket not at all.
  const bool is_output = path == "/dev/stdout" || path == "/dev/fd/1" || path == "/proc/self/fd/1";
  const int descriptor =
      is_output ? fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0) : open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (descriptor < 0) fail(path, "cannot open the file for writing", errno, "check the permissions");
  OutputFile(path, descriptor, false).fill(write, path);
}

/// So that the rename survives a power failure; where that is not possible, nothing is lost before one.
void flush_folder(const fs::path& target) {
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  fsync(descriptor);
  close(descriptor);
}

} // namespace

void write_file_atomically(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write) {
  if (!path.has_filename()) fail(path, "the name of a file is missing", 0, "name the file to be written");
  struct stat status {};
  int mode = -1;
  if (stat(path.c_str(), &status) == 0) {
    if (S_ISDIR(status.st_mode)) fail(path, "this is a folder", 0, "name a file to be written");
    if (access(path.c_str(), W_OK) != 0) fail(path, "the file is write-protected", errno, "write to another file");
    if (is_special(path, status)) return write_through(path, write);
    mode = static_cast<int>(status.st_mode);
  }
  const fs::path target = io::follow_links(path);
  OutputFile file = create_beside(target, mode);
  file.fill(write, path);
  file.rename_to(target);
  flush_folder(target);
}

} // namespace eigencrust
