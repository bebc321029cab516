// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The only place that knows MPI. All ranks make the same calls in the same order, but for abort().
#pragma once

#include <mpi.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace eigencrust::mpi {

/// The ranks of one run. Waiting for others takes no processor: they may be long in a stage that has threads.
class Messages {
 public:
  /// Starts MPI. \param argc, argv as main gets them
  Messages(int& argc, char**& argv);
  /// Ends MPI; all ranks are waited for.
  ~Messages();
  Messages(const Messages&) = delete;
  Messages& operator=(const Messages&) = delete;

  [[nodiscard]] int rank() const { return rank_; }
  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] bool is_root() const { return rank_ == 0; }

  /// The root's value, for all.
  template <class T>
  T from_root(const T& value) const {
    std::vector<T> one{value};
    from_root(one);
    return one.front();
  }
  /// The root's items, for all.
  template <class T>
  void from_root(std::vector<T>& items) const {
    std::uint64_t count = items.size();
    broadcast(&count, 1, sizeof count);
    items.resize(count);
    broadcast(items.data(), count, sizeof(T));
  }
  /// The largest of all ranks' values.
  [[nodiscard]] std::uint64_t largest(std::uint64_t value) const { return reduced(value, MPI_MAX); }
  /// The sum of all ranks' values.
  [[nodiscard]] std::uint64_t sum(std::uint64_t value) const { return reduced(value, MPI_SUM); }

  /// Items of each rank to each rank. \param out one for each rank \return one from each rank
  template <class T>
  std::vector<std::vector<T>> exchange(const std::vector<std::vector<T>>& out) const {
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<std::uint64_t> counts(out.size());
    for (std::size_t r = 0; r < out.size(); ++r) counts[r] = out[r].size();
    const std::vector<std::uint64_t> coming = exchange_counts(counts);
    std::vector<std::vector<T>> in(out.size());
    std::vector<Part> sent, received;
    for (std::size_t r = 0; r < out.size(); ++r) {
      in[r].resize(coming[r]);
      sent.push_back({const_cast<T*>(out[r].data()), out[r].size()});
      received.push_back({in[r].data(), in[r].size()});
    }
    exchange(sent, received, sizeof(T));
    return in;
  }

  /// Ends all ranks at once: this one cannot go on to where the others wait for it.
  /// \param status of the run
  [[noreturn]] void abort(int status) const;

  /// Bytes that this rank has sent to others so far.
  [[nodiscard]] std::uint64_t bytes_sent() const { return bytes_sent_; }

 private:
  struct Part {
    void* items;
    std::uint64_t count;
  };
  [[nodiscard]] std::uint64_t reduced(std::uint64_t value, MPI_Op how) const;
  void broadcast(void* items, std::uint64_t count, std::size_t size) const;
  [[nodiscard]] std::vector<std::uint64_t> exchange_counts(const std::vector<std::uint64_t>& counts) const;
  void exchange(const std::vector<Part>& sent, const std::vector<Part>& received, std::size_t size) const;
  void wait(MPI_Request request) const;
  void wait(std::vector<MPI_Request>& requests) const;

  int rank_ = 0, size_ = 1;
  mutable std::uint64_t bytes_sent_ = 0;
};

} // namespace eigencrust::mpi
