// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What several tests share: the place of the real scans, and a folder that cleans up after itself.
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

#include <eigencrust/error.h>

#include "source_folder.h"

namespace eigencrust {

/// A file of the real data, which may be absent: see EIGENCRUST_NEED_DATA. The folder is
/// EIGENCRUST_DATA of the environment, else shared/data beside the checkout.
inline std::filesystem::path data_path(std::string_view relative) {
  const char* folder = std::getenv("EIGENCRUST_DATA");
  const std::filesystem::path root =
      folder != nullptr && *folder != '\0' ? std::filesystem::path(folder) : source_folder() / ".." / "shared" / "data";
  return root / relative;
}

/// A fresh temporary folder, removed with all it holds at the end of the scope.
class TempDir {
 public:
  TempDir() {
    std::string name = (std::filesystem::temp_directory_path() / "eigencrust-test-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::system_error(errno, std::generic_category(), name);
    path_ = name;
  }
  ~TempDir() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TempDir(const TempDir&) = delete;
  TempDir& operator=(const TempDir&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::filesystem::path operator/(std::string_view name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

/// Writes `bytes` to a file as they are.
inline void write_bytes(const std::filesystem::path& path, std::string_view bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!file.flush()) throw std::runtime_error("cannot write " + path.string());
}

inline std::string read_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot read " + path.string());
  return {std::istreambuf_iterator<char>(file), {}};
}

/// What the eigencrust::Error says that `work` throws; empty when it throws none.
template <class Work>
std::string error_of(Work&& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

} // namespace eigencrust

/// Skips the test, saying why, where a file (or folder) of the real data is absent.
#define EIGENCRUST_NEED_DATA(path)                                                                                 \
  do {                                                                                                             \
    const auto& needed_path = (path);                                                                              \
    if (!std::filesystem::exists(needed_path)) GTEST_SKIP() << "real data not here: " << std::string(needed_path); \
  } while (false)
