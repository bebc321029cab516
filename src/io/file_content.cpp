// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/file_content.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

#include <eigencrust/error.h>

#include "io/system_call.h"

namespace eigencrust::io {
namespace {

struct Descriptor {
  int value;
  explicit Descriptor(int descriptor) : value(descriptor) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (value >= 0) close(value);
  }
};

std::string system_message(int code) { return std::generic_category().message(code); }

} // namespace

FileContent::FileContent(const std::filesystem::path& path) : name_(path.string()) {
  const Descriptor file(uninterrupted([&] { return open(path.c_str(), O_RDONLY | O_CLOEXEC); }));
  if (file.value < 0) fail("cannot open the file: " + system_message(errno), "check the name and the permissions");
  struct stat status {};
  if (fstat(file.value, &status) != 0) fail("cannot read the file: " + system_message(errno), "check the disk");
  if (S_ISDIR(status.st_mode)) fail("this is a folder, not a file", "name a file");

  // One byte more than the size tells the end of a regular file with a single read.
  std::size_t capacity = S_ISREG(status.st_mode) ? static_cast<std::size_t>(status.st_size) + 1 : 65536;
  data_ = std::make_unique_for_overwrite<char[]>(capacity);
  for (;;) {
    if (size_ == capacity) {
      capacity *= 2;
      auto larger = std::make_unique_for_overwrite<char[]>(capacity);
      std::copy_n(data_.get(), size_, larger.get());
      data_ = std::move(larger);
    }
    const ssize_t got =
        when_ready(file.value, POLLIN, [&] { return read(file.value, data_.get() + size_, capacity - size_); });
    if (got < 0) fail("cannot read the file: " + system_message(errno), "check the disk");
    if (got == 0) return;
    size_ += static_cast<std::size_t>(got);
  }
}

FileContent::FileContent(std::string name, std::string_view bytes)
    : name_(std::move(name)), data_(std::make_unique_for_overwrite<char[]>(bytes.size())), size_(bytes.size()) {
  std::copy(bytes.begin(), bytes.end(), data_.get());
}

void FileContent::fail_at_line(std::uint64_t line, const std::string& cause, const std::string& remedy) const {
  throw Error(ErrorKind::input, name_ + ":" + std::to_string(line), cause, remedy);
}

void FileContent::fail_at_byte(std::uint64_t offset, const std::string& cause, const std::string& remedy) const {
  throw Error(ErrorKind::input, name_, cause + " at byte " + std::to_string(offset), remedy);
}

void FileContent::fail(const std::string& cause, const std::string& remedy) const {
  throw Error(ErrorKind::input, name_, cause, remedy);
}

} // namespace eigencrust::io
