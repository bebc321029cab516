// SPDX-License-Identifier: GPL-3.0-or-later
#include "messages.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <thread>

namespace eigencrust::mpi {
namespace {

// MPI counts with int. Larger messages are sent in pieces.
constexpr std::uint64_t largest_piece = std::uint64_t{1} << 28;

// Until then a waiting rank asks as often as it can: most messages come at once.
constexpr int looks_without_sleep = 1000;
constexpr auto first_sleep = std::chrono::microseconds(20), longest_sleep = std::chrono::microseconds(2000);

} // namespace

Messages::Messages(int& argc, char**& argv) {
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
}

Messages::~Messages() {
  // MPI_Finalize waits, too, but with all its might.
  MPI_Request all = MPI_REQUEST_NULL;
  MPI_Ibarrier(MPI_COMM_WORLD, &all);
  wait(all);
  MPI_Finalize();
}

void Messages::abort(int status) const {
  MPI_Abort(MPI_COMM_WORLD, status);
  std::_Exit(status); // it does not return
}

void Messages::wait(MPI_Request request) const {
  std::vector<MPI_Request> one{request};
  wait(one);
}

void Messages::wait(std::vector<MPI_Request>& requests) const {
  auto sleep = first_sleep;
  for (int looks = 0;; ++looks) {
    int done = 0;
    MPI_Testall(static_cast<int>(requests.size()), requests.data(), &done, MPI_STATUSES_IGNORE);
    if (done != 0) return;
    if (looks < looks_without_sleep) continue;
    std::this_thread::sleep_for(sleep);
    sleep = std::min(2 * sleep, longest_sleep);
  }
}

void Messages::broadcast(void* items, std::uint64_t count, std::size_t size) const {
  auto* bytes = static_cast<std::byte*>(items);
  for (std::uint64_t left = count * size; left > 0;) {
    const std::uint64_t piece = std::min(left, largest_piece);
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Ibcast(bytes, static_cast<int>(piece), MPI_BYTE, 0, MPI_COMM_WORLD, &request);
    wait(request);
    bytes += piece;
    left -= piece;
  }
  if (is_root()) bytes_sent_ += count * size * static_cast<std::uint64_t>(size_ - 1);
}

std::uint64_t Messages::reduced(std::uint64_t value, MPI_Op how) const {
  std::uint64_t result = 0;
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Iallreduce(&value, &result, 1, MPI_UINT64_T, how, MPI_COMM_WORLD, &request);
  wait(request);
  return result;
}

std::vector<std::uint64_t> Messages::exchange_counts(const std::vector<std::uint64_t>& counts) const {
  std::vector<std::uint64_t> coming(counts.size());
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Ialltoall(counts.data(), 1, MPI_UINT64_T, coming.data(), 1, MPI_UINT64_T, MPI_COMM_WORLD, &request);
  wait(request);
  return coming;
}

void Messages::exchange(const std::vector<Part>& sent, const std::vector<Part>& received, std::size_t size) const {
  std::vector<MPI_Request> requests;
  // Pieces between two ranks stay in order, so one tag is enough.
  const auto in_pieces = [&](const Part& part, auto&& start) {
    auto* bytes = static_cast<std::byte*>(part.items);
    for (std::uint64_t left = part.count * size; left > 0;) {
      const std::uint64_t piece = std::min(left, largest_piece);
      start(bytes, static_cast<int>(piece), &requests.emplace_back(MPI_REQUEST_NULL));
      bytes += piece;
      left -= piece;
    }
  };
  for (int r = 0; r < size_; ++r) {
    const auto at = static_cast<std::size_t>(r);
    if (r == rank_) {
      std::copy_n(static_cast<const std::byte*>(sent[at].items), sent[at].count * size,
                  static_cast<std::byte*>(received[at].items));
      continue;
    }
    bytes_sent_ += sent[at].count * size;
    in_pieces(received[at], [&](void* bytes, int count, MPI_Request* request) {
      MPI_Irecv(bytes, count, MPI_BYTE, r, 0, MPI_COMM_WORLD, request);
    });
    in_pieces(sent[at], [&](const void* bytes, int count, MPI_Request* request) {
      MPI_Isend(bytes, count, MPI_BYTE, r, 0, MPI_COMM_WORLD, request);
    });
  }
  wait(requests);
}

} // namespace eigencrust::mpi
