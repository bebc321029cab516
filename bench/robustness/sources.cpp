// SPDX-License-Identifier: GPL-3.0-or-later
#include "sources.h"

#include <string_view>

#include <eigencrust/eigencrust.h>
#include <eigencrust/io.h>

namespace eigencrust::bench {
namespace {

/// The entry of that name, made when it is asked for the first time.
template <class Map, class Make>
const typename Map::mapped_type& cached(Map& map, const std::string& name, Make&& make) {
  const auto found = map.find(name);
  return found != map.end() ? found->second : map.emplace(name, make()).first->second;
}

} // namespace

std::filesystem::path Sources::path(const std::string& file) const {
  constexpr std::string_view prefix = "field/";
  return file.starts_with(prefix) ? field_ / file.substr(prefix.size()) : folder_ / file;
}

bool Sources::has(const std::string& file) const { return std::filesystem::is_regular_file(path(file)); }

const Truth& Sources::truth(const std::string& file) {
  return cached(truths_, file, [&] { return truth_of(read_mesh(path(file))); });
}

const std::vector<Vec3>& Sources::points(const std::string& file) {
  return cached(points_, file, [&] { return read_point_cloud(path(file)).points; });
}

const Truth& Sources::reference(const std::string& file) {
  return cached(references_, file, [&] {
    Options options = Options::of(Preset::robust);
    options.threads = threads_;
    return truth_of(reconstruct({points(file), {}, {}}, options).mesh);
  });
}

} // namespace eigencrust::bench
