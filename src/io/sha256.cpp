// SPDX-License-Identifier: GPL-3.0-or-later
#include <openssl/evp.h>

#include <array>
#include <memory>

#include <eigencrust/error.h>
#include <eigencrust/io.h>

#include "io/sha256.h"

namespace eigencrust {

std::string io::sha256_of(const FileContent& file) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  const std::string_view bytes = file.bytes();
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1)
    throw Error(ErrorKind::input, file.name(), "the SHA-256 of the file cannot be computed", "check OpenSSL");
  static constexpr char digits[] = "0123456789abcdef";
  std::string text;
  for (unsigned i = 0; i < size; ++i) {
    text += digits[digest[i] >> 4];
    text += digits[digest[i] & 15];
  }
  return text;
}

std::string sha256_of_file(const std::filesystem::path& path) { return io::sha256_of(io::FileContent(path)); }

} // namespace eigencrust
