// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What is told of a cloud alone: how much memory and time reconstruct() will take (docs/decisions/0018), and what is
/// in it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include <eigencrust/types.h>

namespace eigencrust {

/// What a reconstruction will take.
struct Forecast {
  std::uint64_t memory_bytes = 0; ///< largest resident memory of the process
  double seconds = 0;             ///< one thread of the machine it was measured on: a rough figure
};

/// For a cloud of `points` rows. \param further_bytes what its attributes and indices take beside the coordinates
Forecast forecast(std::uint64_t points, std::uint64_t further_bytes = 0);
/// The same for this cloud with its attributes.
Forecast forecast(const PointCloud& cloud);

/// Bytes of a cloud beside its coordinates.
std::uint64_t further_bytes(const PointCloud& cloud);

/// \throws Error{memory} when the forecast for the cloud exceeds `limit` bytes; 0: no limit
void check_memory(const PointCloud& cloud, std::uint64_t limit);

/// The same while the tetrahedra grow: a few clouds (two curves that wind around each other) have as many as the square
/// of their samples. \param further as above
/// \throws Error{memory} when so many tetrahedra will take more than `limit` bytes; 0: no limit
void check_memory_of_tetrahedra(std::uint64_t tetrahedra, std::uint64_t further, std::uint64_t limit);

/// Bytes that this process may take in all: what the system has to spare beside what the process holds already,
/// or the limit of its control group (versions 1 and 2) if that is less. 0: not known.
/// \param root where the file system begins, for tests
std::uint64_t available_memory_bytes(const std::filesystem::path& root = "/");

/// What there is to say when the forecast exceeds what is available; empty: nothing.
std::string memory_warning(const Forecast& forecast, std::uint64_t available);

/// "4G", "500M", "1.5Gi", "4000000000": K, M, G and T are powers of 1000, Ki, Mi, Gi and Ti of 1024; B may follow.
/// \throws Error{usage}
std::uint64_t parse_memory_size(const std::string& text);

/// Bytes for people: "3.3 GB", powers of 1000.
std::string describe_bytes(std::uint64_t bytes);

/// What is in a cloud, as `eigencrust info --json` prints it but for the files: counts, scans, sensors, attributes,
/// spacing, bounds, forecast. A cloud that no surface can be made of says why under "unusable".
std::string info_json(const PointCloud& cloud, unsigned threads = 0);

} // namespace eigencrust
