/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A program in C: a sphere through the C interface, options by name, errors as text, cancelling. */
#include <eigencrust_c.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { POINTS = 1000 };

static int complain(const char* what) {
  fprintf(stderr, "c_program: %s\n", what);
  return 1;
}

static void fill_sphere(double* rows, size_t columns) {
  const double pi = 3.14159265358979323846;
  for (size_t i = 0; i < POINTS; ++i) {
    const double z = 1 - 2 * ((double)i + 0.5) / POINTS, r = sqrt(1 - z * z), a = (double)i * pi * (3 - sqrt(5.0));
    rows[columns * i] = r * cos(a);
    rows[columns * i + 1] = r * sin(a);
    rows[columns * i + 2] = z;
  }
}

static double volume_of(const eigencrust_result* result) {
  const double* v = eigencrust_result_vertices(result);
  const uint32_t* t = eigencrust_result_triangles(result);
  double six = 0;
  for (size_t i = 0; i < eigencrust_result_triangle_count(result); ++i) {
    const double *a = v + 3 * t[3 * i], *b = v + 3 * t[3 * i + 1], *c = v + 3 * t[3 * i + 2];
    six += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return six / 6;
}

static int stop_at_second_stage(const char* stage, double fraction, void* user) {
  (void)stage;
  (void)fraction;
  return ++*(int*)user > 1;
}

static int check_errors(const eigencrust_cloud* cloud) {
  eigencrust_error error;
  eigencrust_result* result = NULL;
  const eigencrust_cloud none = {0};
  if (eigencrust_reconstruct(&none, NULL, NULL, NULL, &result, &error) != EIGENCRUST_INPUT || result != NULL)
    return complain("no points, no complaint");
  if (error.cause[0] == 0 || error.remedy[0] == 0 || error.stage[0] == 0) return complain("the complaint is empty");
  if (eigencrust_reconstruct(NULL, NULL, NULL, NULL, &result, NULL) != EIGENCRUST_USAGE) return complain("NULL passed");
  int calls = 0;
  if (eigencrust_reconstruct(cloud, NULL, stop_at_second_stage, &calls, &result, &error) != EIGENCRUST_CANCELLED)
    return complain("it was not cancelled");
  if (calls != 2) return complain("the callback was called after it had said stop");
  eigencrust_options* options = eigencrust_options_new();
  if (eigencrust_options_set(options, "nois", "off", &error) != EIGENCRUST_USAGE || !strstr(error.remedy, "noise"))
    return complain("an unknown option passed");
  if (eigencrust_options_set(options, "smooth", "many", &error) != EIGENCRUST_USAGE) return complain("bad value passed");
  eigencrust_options_free(options);
  return 0;
}

static int check_options(const eigencrust_cloud* cloud, double plain_volume) {
  eigencrust_error error;
  eigencrust_result* result = NULL;
  eigencrust_options* options = eigencrust_options_new();
  if (eigencrust_options_set(options, "smooth", "5", &error) != EIGENCRUST_DONE ||
      eigencrust_options_set(options, "point_results", "on", &error) != EIGENCRUST_DONE)
    return complain(error.cause);
  if (eigencrust_reconstruct(cloud, options, NULL, NULL, &result, &error) != EIGENCRUST_DONE) return complain(error.cause);
  if (!(volume_of(result) < plain_volume)) return complain("smoothing did nothing");
  const double* normals = eigencrust_result_normals(result);
  for (size_t i = 0; i < POINTS; ++i) {
    const double* p = (const double*)((const char*)cloud->points + i * cloud->stride);
    if (!eigencrust_result_inlier(result)[i] || eigencrust_result_confidence(result)[i] < 0.5f)
      return complain("a point of the sphere is an outlier");
    if (normals[3 * i] * p[0] + normals[3 * i + 1] * p[1] + normals[3 * i + 2] * p[2] < 0.9)
      return complain("a normal looks inward");
  }
  eigencrust_result_free(result);
  eigencrust_options_free(options);
  for (size_t i = 0; i < eigencrust_option_count(); ++i)
    if (strlen(eigencrust_option_name(i)) == 0 || strlen(eigencrust_option_help(i)) == 0) return complain("no help");
  return eigencrust_option_name(eigencrust_option_count()) == NULL ? 0 : complain("one option too many");
}

int main(void) {
  double* rows = calloc((size_t)POINTS * 4, sizeof(double)); /* four columns: the stride is used */
  if (rows == NULL) return complain("no memory");
  fill_sphere(rows, 4);
  eigencrust_cloud cloud = {0};
  cloud.points = rows;
  cloud.count = POINTS;
  cloud.stride = 4 * sizeof(double);
  eigencrust_error error;
  eigencrust_result* result = NULL;
  if (eigencrust_reconstruct(&cloud, NULL, NULL, NULL, &result, &error) != EIGENCRUST_DONE) return complain(error.cause);
  const double volume = volume_of(result);
  if (fabs(volume / 4.18879 - 1) > 0.02) return complain("the volume is wrong");
  for (size_t i = 0; i < eigencrust_result_vertex_count(result); ++i)
    if (memcmp(eigencrust_result_vertices(result) + 3 * i, rows + 4 * eigencrust_result_source_index(result)[i],
               3 * sizeof(double)) != 0)
      return complain("a vertex is not its point");
  if (strstr(eigencrust_result_report(result), "\"schema\"") == NULL) return complain("no report");
  if (eigencrust_result_inlier(result) != NULL) return complain("points are described though nobody asked");
  if (eigencrust_result_warning(result, eigencrust_result_warning_count(result)) != NULL) return complain("a warning");
  printf("c_program: eigencrust %s works, %zu triangles\n", eigencrust_version(),
         eigencrust_result_triangle_count(result));
  eigencrust_result_free(result);
  const int status = check_errors(&cloud) + check_options(&cloud, volume);
  free(rows);
  return status;
}
