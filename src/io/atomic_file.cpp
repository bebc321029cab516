// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <locale>
#include <streambuf>
#include <system_error>

#include <eigencrust/io.h>

#include "io/offset_file.h"
#include "io/system_call.h"
#include "io/temporary_file.h"

namespace eigencrust {
namespace {

namespace fs = std::filesystem;

using io::fail;

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
      const ssize_t written = io::when_ready(descriptor_, POLLOUT, [&] { return write(descriptor_, text, size); });
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

/// Lets `write` fill the file and makes sure that it arrived. \param path for messages
void fill(int descriptor, const std::function<void(std::ostream&)>& write, const fs::path& path) {
  DescriptorBuffer buffer(descriptor);
  std::ostream out(&buffer);
  out.imbue(std::locale::classic());
  write(out);
  out.flush();
  if (buffer.error() != 0 || !out) fail(path, "cannot write the file", buffer.error(), "check the space on the disk");
  // Pipes and some file systems know no fsync.
  if (io::uninterrupted([&] { return fsync(descriptor); }) != 0 && errno != EINVAL && errno != ENOTSUP &&
      errno != EROFS)
    fail(path, "cannot write the file", errno, "check the space on the disk");
}

/// Devices, pipes and what stands for a descriptor of the process cannot be replaced by another file.
bool is_special(const fs::path& path, const struct stat& status) {
  const std::string name = path.string();
  return !S_ISREG(status.st_mode) || name.starts_with("/dev/") || name.starts_with("/proc/");
}

void write_through(const fs::path& path, const std::function<void(std::ostream&)>& write) {
  // Standard output is written where it stands: opened anew, a file behind it would be written from its beginning, and
  // a socket not at all.
  const bool is_output = path == "/dev/stdout" || path == "/dev/fd/1" || path == "/proc/self/fd/1";
  const int descriptor = is_output ? fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0)
                                   : io::uninterrupted([&] { return open(path.c_str(), O_WRONLY | O_CLOEXEC); });
  if (descriptor < 0) fail(path, "cannot open the file for writing", errno, "check the permissions");
  struct Closed {
    int descriptor;
    ~Closed() {
      if (descriptor >= 0) close(descriptor);
    }
  } closed{descriptor};
  fill(descriptor, write, path);
  closed.descriptor = -1;
  if (close(descriptor) != 0 && errno != EINTR)
    fail(path, "cannot write the file", errno, "check the space on the disk");
}

} // namespace

fs::path follow_links(const fs::path& path) {
  constexpr int most_links = 40; // as the system has it
  fs::path place = path;
  for (int steps = 0; steps < most_links; ++steps) {
    std::error_code error;
    const fs::path next = fs::read_symlink(place, error);
    if (error) return place;
    place = next.is_absolute() ? next : place.parent_path() / next;
  }
  return place;
}

struct OutputFiles::Impl {
  std::vector<std::unique_ptr<io::TemporaryFile>> files;
  std::vector<fs::path> stale; ///< files of offsets beside results that need none
};

OutputFiles::OutputFiles() : impl_(std::make_unique<Impl>()) {}
OutputFiles::~OutputFiles() = default;

void OutputFiles::add(const fs::path& path, const std::function<void(std::ostream&)>& write) {
  if (!path.has_filename()) fail(path, "the name of a file is missing", 0, "name the file to be written");
  struct stat status {};
  const bool exists = stat(path.c_str(), &status) == 0;
  if (!exists && errno == ELOOP) fail(path, "cannot write the file", errno, "name a file instead of this link");
  if (exists) {
    if (S_ISDIR(status.st_mode)) fail(path, "this is a folder", 0, "name a file to be written");
    if (access(path.c_str(), W_OK) != 0) fail(path, "the file is write-protected", errno, "write to another file");
    if (is_special(path, status)) return write_through(path, write);
  }
  impl_->files.push_back(std::make_unique<io::TemporaryFile>(follow_links(path), exists ? &status : nullptr));
  fill(impl_->files.back()->descriptor(), write, path);
}

void OutputFiles::add_offset(const fs::path& path, const Vec3& offset, std::vector<std::string>& warnings) {
  struct stat status {};
  const bool special = stat(path.c_str(), &status) == 0 && is_special(path, status);
  if (special && offset != Vec3{})
    warnings.push_back("no file can be beside " + path.string() + " to say so: add " + io::three_numbers(offset) +
                       " to its coordinates to return to those of the input");
  if (special) return;
  if (offset != Vec3{})
    add(offset_file(path), [&](std::ostream& out) { out << io::offset_text(path, offset); });
  else
    impl_->stale.push_back(offset_file(path));
}

void OutputFiles::put_in_place() {
  for (const auto& file : impl_->files) file->put_in_place();
  std::error_code ignored;
  for (const fs::path& file : impl_->stale)
    if (io::is_offset_file(file)) fs::remove(file, ignored);
}

void write_file_atomically(const fs::path& path, const std::function<void(std::ostream&)>& write) {
  OutputFiles files;
  files.add(path, write);
  files.put_in_place();
}

} // namespace eigencrust
