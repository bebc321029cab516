// SPDX-License-Identifier: GPL-3.0-or-later
// The functions that OpenSSL 3 calls deprecated take no memory; the new ones crash where there is none.
#define OPENSSL_SUPPRESS_DEPRECATED
#include <openssl/sha.h>

#include <array>

#include <eigencrust/io.h>

#include "io/sha256.h"

namespace eigencrust {

std::string io::sha256_of(const FileContent& file) {
  std::array<unsigned char, SHA256_DIGEST_LENGTH> digest{};
  SHA256_CTX state;
  const std::string_view bytes = file.bytes();
  SHA256_Init(&state);
  SHA256_Update(&state, bytes.data(), bytes.size());
  SHA256_Final(digest.data(), &state);
  static constexpr char digits[] = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : digest) {
    text += digits[byte >> 4];
    text += digits[byte & 15];
  }
  return text;
}

std::string sha256_of_file(const std::filesystem::path& path) { return io::sha256_of(io::FileContent(path)); }

} // namespace eigencrust
