// SPDX-License-Identifier: GPL-3.0-or-later
#include <openssl/evp.h>

#include <array>
#include <memory>

#include <eigencrust/error.h>
#include <eigencrust/io.h>

#include "io/file_content.h"

namespace eigencrust {

std::string sha256_of_file(const std::filesystem::path& path) {
  const io::FileContent file(path);
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  const std::string_view bytes = file.bytes();
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1)
    throw Error(ErrorKind::input, path.string(), "the SHA-256 of the file cannot be computed", "check OpenSSL");
  static constexpr char digits[] = "0123456789abcdef";
  std::string text;
  for (unsigned i = 0; i < size; ++i) {
    text += digits[digest[i] >> 4];
    text += digits[digest[i] & 15];
  }
  return text;
}

} // namespace eigencrust
