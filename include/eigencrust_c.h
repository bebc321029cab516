/* SPDX-License-Identifier: GPL-3.0-or-later */
/** \file
 * Eigencrust for programs in C and in whatever can call C: points in buffers in, a closed manifold mesh in buffers out.
 *
 * Every function that can fail returns a status, 0 for success, and fills `error` where the caller gives one. Nothing
 * is thrown. There is no global state: different threads may work at the same time on different objects.
 */
#ifndef EIGENCRUST_C_H
#define EIGENCRUST_C_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
/** What a shared library shows. */
#define EIGENCRUST_C_API __attribute__((visibility("default")))
#else
#define EIGENCRUST_C_API
#endif

/** The values are those of the command's exit status. */
typedef enum eigencrust_status {
  EIGENCRUST_DONE = 0,
  EIGENCRUST_USAGE = 2,      /**< options or arguments that make no sense */
  EIGENCRUST_INPUT = 3,      /**< points that are unusable */
  EIGENCRUST_MEMORY = 4,     /**< memory refused or exhausted */
  EIGENCRUST_NO_SURFACE = 5, /**< the labels leave no surface */
  EIGENCRUST_GUARANTEE = 6,  /**< a promised property does not hold: a fault of the program */
  EIGENCRUST_CANCELLED = 130 /**< the callback asked for it */
} eigencrust_status;

/** What went wrong, as text that ends in 0. Too long texts are cut. */
typedef struct eigencrust_error {
  char stage[64];   /**< the step or argument where it happened */
  char cause[384];  /**< what is wrong */
  char remedy[384]; /**< what the caller can do about it */
} eigencrust_error;

/** Options by name, made by eigencrust_options_new. */
typedef struct eigencrust_options eigencrust_options;
/** A mesh and what there is to know of it, made by eigencrust_reconstruct. */
typedef struct eigencrust_result eigencrust_result;

/** "MAJOR.MINOR.PATCH" */
EIGENCRUST_C_API const char* eigencrust_version(void);

/** The defaults. NULL: memory is exhausted. To be freed by eigencrust_options_free. */
EIGENCRUST_C_API eigencrust_options* eigencrust_options_new(void);
/** NULL is allowed. */
EIGENCRUST_C_API void eigencrust_options_free(eigencrust_options* options);
/** Sets an option by its name on the command line without the dashes, such as "noise" or "outside-point"; flags are
 *  "on" or "off". "preset" replaces what was set before. `error` may be NULL. */
EIGENCRUST_C_API eigencrust_status eigencrust_options_set(eigencrust_options* options, const char* name,
                                                          const char* value, eigencrust_error* error);

/** How many options there are. */
EIGENCRUST_C_API size_t eigencrust_option_count(void);
/** Name of an option, 0 <= index < count; else NULL. */
EIGENCRUST_C_API const char* eigencrust_option_name(size_t index);
/** Its help; NULL as above. */
EIGENCRUST_C_API const char* eigencrust_option_help(size_t index);

/** Called by the thread that called eigencrust_reconstruct, and by it alone. \param fraction of the stage, in [0, 1]
 *  \return anything but 0 to stop the run */
typedef int (*eigencrust_progress)(const char* stage, double fraction, void* user);

/** What there is to know of the points. Set all to 0 first, so that fields of later versions have their defaults. */
typedef struct eigencrust_cloud {
  const double* points;       /**< count rows x, y, z; rows that are not finite are left out */
  size_t count;               /**< number of rows */
  size_t stride;              /**< bytes from row to row; 0: 3 * sizeof(double) */
  const uint32_t* scan_index; /**< which scan each row came from, numbered from 0; NULL: one scan */
  const double*
      sensors; /**< where the scanner of each row stood, count rows x, y, z, not finite for unknown; or NULL */
} eigencrust_cloud;

/** Reconstructs. \param options NULL: the defaults \param progress may be NULL \param user handed to it
 *  \param result set to NULL, or to a result, to be freed by eigencrust_result_free, also with EIGENCRUST_GUARANTEE
 *  \param error may be NULL */
EIGENCRUST_C_API eigencrust_status eigencrust_reconstruct(const eigencrust_cloud* cloud,
                                                          const eigencrust_options* options,
                                                          eigencrust_progress progress, void* user,
                                                          eigencrust_result** result, eigencrust_error* error);
/** NULL is allowed. */
EIGENCRUST_C_API void eigencrust_result_free(eigencrust_result* result);

/* What follows belongs to the result and lives as long as it does. */
/** Number of vertices. */
EIGENCRUST_C_API size_t eigencrust_result_vertex_count(const eigencrust_result* result);
/** Number of triangles. */
EIGENCRUST_C_API size_t eigencrust_result_triangle_count(const eigencrust_result* result);
/** x, y, z of each vertex. */
EIGENCRUST_C_API const double* eigencrust_result_vertices(const eigencrust_result* result);
/** Three vertices of each triangle, counter-clockwise seen from outside. */
EIGENCRUST_C_API const uint32_t* eigencrust_result_triangles(const eigencrust_result* result);
/** The row that each vertex came from. */
EIGENCRUST_C_API const uint32_t* eigencrust_result_source_index(const eigencrust_result* result);
/** With the option "point-results" one entry per row, else NULL: 1 for samples of the surface. */
EIGENCRUST_C_API const uint8_t* eigencrust_result_inlier(const eigencrust_result* result);
/** The same: how sure that is, in [0, 1]. */
EIGENCRUST_C_API const float* eigencrust_result_confidence(const eigencrust_result* result);
/** The same: unit normals x, y, z that look outward, NaN for outliers. */
EIGENCRUST_C_API const double* eigencrust_result_normals(const eigencrust_result* result);
/** How many warnings there are. */
EIGENCRUST_C_API size_t eigencrust_result_warning_count(const eigencrust_result* result);
/** One of them, 0 <= index < count; else NULL. */
EIGENCRUST_C_API const char* eigencrust_result_warning(const eigencrust_result* result, size_t index);
/** The report as JSON, see docs/report.md. */
EIGENCRUST_C_API const char* eigencrust_result_report(const eigencrust_result* result);

#ifdef __cplusplus
}
#endif

#endif
