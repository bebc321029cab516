// SPDX-License-Identifier: GPL-3.0-or-later
#include <eigencrust_c.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <stdexcept>

#include <eigencrust/eigencrust.h>
#include <eigencrust/option_table.h>

#include "evidence/sensor_rows.h"

using namespace eigencrust;

struct eigencrust_options {
  Options options;
};

struct eigencrust_result {
  Result result;
  std::vector<std::uint32_t> source_index;
  std::string report;
};

namespace {

static_assert(sizeof(Vec3) == 3 * sizeof(double), "rows of coordinates are handed out as they are");

template <std::size_t size>
void fill(char (&to)[size], const std::string& text) {
  std::memset(to, 0, size);
  std::memcpy(to, text.data(), std::min(text.size(), size - 1));
}

eigencrust_status fail(eigencrust_error* error, ErrorKind kind, const std::string& stage, const std::string& cause,
                       const std::string& remedy) {
  if (error != nullptr) {
    fill(error->stage, stage);
    fill(error->cause, cause);
    fill(error->remedy, remedy);
  }
  return static_cast<eigencrust_status>(kind);
}

/// Runs what may throw; nothing leaves it.
template <class Work>
eigencrust_status guarded(eigencrust_error* error, Work&& work) noexcept {
  if (error != nullptr) *error = {};
  const auto exhausted = [&] {
    return fail(error, ErrorKind::memory, "memory", "memory is exhausted", "give fewer points");
  };
  try {
    work();
    return EIGENCRUST_DONE;
  } catch (const Error& e) {
    return fail(error, e.kind(), e.place(), e.cause(), e.remedy());
  } catch (const std::bad_alloc&) {
    return exhausted();
  } catch (const std::length_error&) { // a container larger than any memory
    return exhausted();
  } catch (const std::exception& e) {
    return fail(error, ErrorKind::guarantee, "internal", e.what(), "report this as a fault of the program");
  } catch (...) {
    return fail(error, ErrorKind::guarantee, "internal", "something was thrown",
                "report this as a fault of the program");
  }
}

void require(bool fine, const char* argument, const char* cause) {
  if (!fine) throw Error(ErrorKind::usage, argument, cause, "see eigencrust_c.h");
}

class CallbackObserver : public Observer {
 public:
  CallbackObserver(eigencrust_progress callback, void* user) : progress_(callback), user_(user) {}

  void stage_begins(std::string_view stage) override {
    stage_ = stage;
    tell(0);
  }
  void progress(double fraction) override { tell(fraction); }
  bool cancelled() override { return stop_; }

 private:
  void tell(double fraction) {
    if (progress_ != nullptr && !stop_ && progress_(stage_.c_str(), fraction, user_) != 0) stop_ = true;
  }
  eigencrust_progress progress_;
  void* user_;
  std::string stage_;
  std::atomic<bool> stop_ = false; // workers ask, too
};

Vec3 row_at(const double* rows, std::size_t stride, std::size_t i) {
  Vec3 row;
  std::memcpy(&row, reinterpret_cast<const char*>(rows) + i * stride, sizeof row);
  return row;
}

PointCloud cloud_of(const eigencrust_cloud& given) {
  const std::size_t row = sizeof(Vec3), stride = given.stride == 0 ? row : given.stride;
  require(given.points != nullptr || given.count == 0, "points", "the pointer is null");
  require(stride >= row, "stride", "rows overlap");
  PointCloud cloud;
  cloud.points.resize(given.count);
  for (std::size_t i = 0; i < given.count; ++i) cloud.points[i] = row_at(given.points, stride, i);
  if (given.scan_index != nullptr) cloud.scan_index.assign(given.scan_index, given.scan_index + given.count);
  if (given.sensors != nullptr) {
    std::vector<Vec3> places(given.count);
    for (std::size_t i = 0; i < given.count; ++i) places[i] = row_at(given.sensors, row, i);
    set_sensor_rows(cloud, places);
  }
  return cloud;
}

std::unique_ptr<eigencrust_result> pack(Result result) {
  auto packed = std::make_unique<eigencrust_result>();
  packed->result = std::move(result);
  packed->result.tetrahedralization = {};
  const Attribute* source = find_attribute(packed->result.mesh.vertex_attributes, "source_index");
  if (source != nullptr && source->type == ScalarType::uint32) {
    packed->source_index.resize(source->rows());
    std::memcpy(packed->source_index.data(), source->values.data(), source->values.size());
  }
  packed->report = to_json(packed->result.report);
  return packed;
}

template <class To, class From>
const To* rows_or_null(const std::vector<From>& rows) {
  return rows.empty() ? nullptr : reinterpret_cast<const To*>(rows.data());
}

} // namespace

const char* eigencrust_version(void) { return version(); }

eigencrust_options* eigencrust_options_new(void) {
  eigencrust_options* made = nullptr;
  guarded(nullptr, [&] { made = new eigencrust_options; });
  return made;
}

void eigencrust_options_free(eigencrust_options* options) { delete options; }

eigencrust_status eigencrust_options_set(eigencrust_options* options, const char* name, const char* value,
                                         eigencrust_error* error) {
  return guarded(error, [&] {
    require(options != nullptr && name != nullptr && value != nullptr, "eigencrust_options_set", "a pointer is null");
    Options changed = options->options;
    set_option(changed, name, value);
    check_options(changed);
    options->options = std::move(changed);
  });
}

size_t eigencrust_option_count(void) { return option_table().size(); }

const char* eigencrust_option_name(size_t index) {
  return index < option_table().size() ? option_table()[index].name.data() : nullptr;
}

const char* eigencrust_option_help(size_t index) {
  return index < option_table().size() ? option_table()[index].help.data() : nullptr;
}

eigencrust_status eigencrust_reconstruct(const eigencrust_cloud* cloud, const eigencrust_options* options,
                                         eigencrust_progress progress, void* user, eigencrust_result** result,
                                         eigencrust_error* error) {
  if (result != nullptr) *result = nullptr;
  return guarded(error, [&] {
    require(cloud != nullptr && result != nullptr, "eigencrust_reconstruct", "a pointer is null");
    CallbackObserver observer(progress, user);
    auto packed = pack(reconstruct(cloud_of(*cloud), options == nullptr ? Options{} : options->options, observer));
    const std::vector<std::string> broken = packed->result.report.broken_guarantees;
    *result = packed.release();
    if (!broken.empty())
      throw Error(ErrorKind::guarantee, "validate", "the mesh is not " + broken.front(),
                  "report this as a fault of the program");
  });
}

void eigencrust_result_free(eigencrust_result* result) { delete result; }

size_t eigencrust_result_vertex_count(const eigencrust_result* r) { return r->result.mesh.vertices.size(); }
size_t eigencrust_result_triangle_count(const eigencrust_result* r) { return r->result.mesh.triangles.size(); }
const double* eigencrust_result_vertices(const eigencrust_result* r) {
  return rows_or_null<double>(r->result.mesh.vertices);
}
const uint32_t* eigencrust_result_triangles(const eigencrust_result* r) {
  return rows_or_null<std::uint32_t>(r->result.mesh.triangles);
}
const uint32_t* eigencrust_result_source_index(const eigencrust_result* r) {
  return rows_or_null<std::uint32_t>(r->source_index);
}
const uint8_t* eigencrust_result_inlier(const eigencrust_result* r) {
  return rows_or_null<std::uint8_t>(r->result.inlier);
}
const float* eigencrust_result_confidence(const eigencrust_result* r) {
  return rows_or_null<float>(r->result.confidence);
}
const double* eigencrust_result_normals(const eigencrust_result* r) { return rows_or_null<double>(r->result.normals); }
size_t eigencrust_result_warning_count(const eigencrust_result* r) { return r->result.report.warnings.size(); }
const char* eigencrust_result_warning(const eigencrust_result* r, size_t index) {
  const auto& warnings = r->result.report.warnings;
  return index < warnings.size() ? warnings[index].c_str() : nullptr;
}
const char* eigencrust_result_report(const eigencrust_result* r) { return r->report.c_str(); }
