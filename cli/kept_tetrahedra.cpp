// SPDX-License-Identifier: GPL-3.0-or-later
#include "kept_tetrahedra.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>

#include <eigencrust/eigencrust.h>
#include <eigencrust/error.h>
#include <eigencrust/io.h>

namespace eigencrust::cli {
namespace {

/// Of bytes, eight at a time: tells damage and other samples, not malice.
class Sum {
 public:
  void add(std::span<const std::byte> bytes) {
    for (std::size_t i = 0; i < bytes.size(); i += sizeof(std::uint64_t)) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes.data() + i, std::min(sizeof word, bytes.size() - i));
      // Multiplier of SplitMix64 (Steele, Lea and Flood 2014).
      sum_ = (sum_ ^ word) * 0xbf58476d1ce4e5b9;
      sum_ ^= sum_ >> 32;
    }
  }
  [[nodiscard]] std::uint64_t value() const { return sum_; }

 private:
  std::uint64_t sum_ = 0x9e3779b97f4a7c15;
};

/// At the head of the file: what it is, which program wrote it, and how that writes numbers.
struct Head {
  std::array<char, 24> what{}, version{};
  std::uint64_t byte_order = 0x0102030405060708;
  std::uint64_t samples = 0, tetrahedra = 0;
  bool operator==(const Head&) const = default;
};

Head head_of(std::uint64_t samples, std::uint64_t tetrahedra) {
  Head head;
  std::strncpy(head.what.data(), "eigencrust tetrahedra\n", head.what.size() - 1);
  std::strncpy(head.version.data(), version(), head.version.size() - 1);
  head.samples = samples;
  head.tetrahedra = tetrahedra;
  return head;
}

template <class T>
std::span<const std::byte> bytes_of(const std::vector<T>& items) {
  return std::as_bytes(std::span(items));
}

/// A folder can hold those of several clouds.
std::string name_of(const Samples& samples) {
  Sum sum;
  sum.add(std::as_bytes(std::span(&samples.origin, 1)));
  sum.add(bytes_of(samples.positions.raw()));
  std::array<char, 48> name{};
  std::snprintf(name.data(), name.size(), "tetrahedra-%016llx.eigencrust",
                static_cast<unsigned long long>(sum.value()));
  return name.data();
}

class Reader {
 public:
  explicit Reader(const std::string& path) : in_(path, std::ios::binary) {}
  [[nodiscard]] bool is_open() const { return in_.is_open(); }
  template <class T>
  bool read(T* items, std::size_t count) {
    in_.read(reinterpret_cast<char*>(items), static_cast<std::streamsize>(count * sizeof(T)));
    if (in_) sum_.add(std::as_bytes(std::span(items, count)));
    return static_cast<bool>(in_);
  }
  /// The last thing in the file.
  bool is_whole() {
    std::uint64_t written = 0;
    in_.read(reinterpret_cast<char*>(&written), sizeof written);
    return in_ && written == sum_.value() && in_.peek() == std::ifstream::traits_type::eof();
  }

 private:
  std::ifstream in_;
  Sum sum_;
};

} // namespace

Tetrahedralization KeptTetrahedra::tetrahedralize(Samples samples, const Threads& threads, const WatchGrowth& watch,
                                                  std::uint64_t /*max_memory*/) {
  file_ = (std::filesystem::path(folder_) / name_of(samples)).string();
  resumed_ = false;
  if (resume_) {
    Tetrahedralization found = kept(samples);
    resumed_ = !found.tetrahedra.empty();
    if (resumed_ && watch) watch(1, found.tetrahedra.size()); // the limit of memory may be another today
    if (resumed_) return found;
  }
  Tetrahedralization made = ranks_ != nullptr
                                ? ranks_->tetrahedralize(std::move(samples), threads, watch, limit_of_ranks_)
                                : eigencrust::tetrahedralize(std::move(samples), threads, watch);
  keep(made);
  return made;
}

Tetrahedralization KeptTetrahedra::kept(Samples& samples) {
  Reader in(file_);
  if (!in.is_open()) return {};
  const auto damaged = [&] {
    warnings_.push_back(file_ + " is damaged or of another version: the tetrahedra were made anew");
    return Tetrahedralization{};
  };
  Head head;
  std::error_code error;
  const std::uint64_t size = std::filesystem::file_size(file_, error);
  Tetrahedralization t;
  auto& [origin, sample_count, positions, source, tetrahedra, neighbours] = t;
  constexpr std::uint64_t corners = 8, bytes_of_a_tetrahedron = 2 * sizeof(std::array<VertexIndex, 4>);
  // Nothing is allocated that the file could not hold.
  if (!in.read(&head, 1) || error || head != head_of(samples.positions.size(), head.tetrahedra) ||
      head.tetrahedra > size / bytes_of_a_tetrahedron)
    return damaged();
  positions.raw().resize(head.samples + corners);
  tetrahedra.raw().resize(head.tetrahedra);
  neighbours.raw().resize(head.tetrahedra);
  if (!in.read(&origin, 1) || !in.read(positions.raw().data(), positions.size()) ||
      !in.read(tetrahedra.raw().data(), tetrahedra.size()) || !in.read(neighbours.raw().data(), neighbours.size()) ||
      !in.is_whole())
    return damaged();
  // The name says so already, but for accidents.
  if (origin != samples.origin ||
      !std::equal(samples.positions.raw().begin(), samples.positions.raw().end(), positions.raw().begin()))
    return damaged();
  sample_count = samples.positions.size();
  source = std::move(samples.source);
  return t;
}

void KeptTetrahedra::keep(const Tetrahedralization& t) {
  try {
    write_file_atomically(file_, [&](std::ostream& out) {
      Sum sum;
      const auto put = [&](std::span<const std::byte> bytes) {
        out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        sum.add(bytes);
      };
      const Head head = head_of(t.sample_count, t.tetrahedra.size());
      put(std::as_bytes(std::span(&head, 1)));
      put(std::as_bytes(std::span(&t.origin, 1)));
      put(bytes_of(t.positions.raw()));
      put(bytes_of(t.tetrahedra.raw()));
      put(bytes_of(t.neighbours.raw()));
      const std::uint64_t whole = sum.value();
      out.write(reinterpret_cast<const char*>(&whole), sizeof whole);
    });
  } catch (const Error& error) { // the run does not need it
    warnings_.push_back(std::string("the tetrahedra could not be kept: ") + error.what());
  }
}

std::vector<std::pair<std::string, double>> KeptTetrahedra::counts() const {
  if (resumed_) return {{"resumed", 1}};
  return ranks_ != nullptr ? ranks_->counts() : std::vector<std::pair<std::string, double>>{};
}

void KeptTetrahedra::forget() const {
  std::error_code ignored; // what stays is found there by its name
  if (!file_.empty()) std::filesystem::remove(file_, ignored);
}

} // namespace eigencrust::cli
