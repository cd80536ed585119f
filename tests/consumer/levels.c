/* An example of a program that uses the library. It prints a log's levels and series, then the
 * volume and the fields' ranges at one level.
 *   levels LOG.qtet LEVEL     "full" is the last level */
#include <qtet/qtet.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int failed(qtet_log* log) {
  fprintf(stderr, "levels: %s\n", qtet_log_error(log));
  qtet_log_destroy(log);
  return EXIT_FAILURE;
}

static double volume(const double* points, size_t count, const uint32_t* tetrahedra) {
  double sum = 0, e[3][3];
  for (; count > 0; --count, tetrahedra += 4) {
    for (int i = 0; i < 3; ++i)
      for (int axis = 0; axis < 3; ++axis)
        e[i][axis] = points[3 * tetrahedra[i + 1] + axis] - points[3 * tetrahedra[0] + axis];
    sum += (e[0][1] * e[1][2] - e[0][2] * e[1][1]) * e[2][0] +
           (e[0][2] * e[1][0] - e[0][0] * e[1][2]) * e[2][1] +
           (e[0][0] * e[1][1] - e[0][1] * e[1][0]) * e[2][2];
  }
  return sum / 6;
}

static void printRange(const char* name, const double* values, size_t count) {
  double low = values[0], high = values[0];
  for (size_t i = 1; i < count; ++i)
    low = values[i] < low ? values[i] : low, high = values[i] > high ? values[i] : high;
  printf("%s: %.9g to %.9g\n", name, low, high);
}

static int printSeries(qtet_log* log, uint32_t number) {
  qtet_series_info series;
  if (qtet_log_get_series(log, number, sizeof series, &series)) return 0;
  double* times = malloc(series.instants * sizeof *times);
  const int isThere = times && !qtet_log_copy_series(log, number, series.instants, times, NULL);
  if (isThere)
    printf("series %s: %u instants, %.9g to %.9g\n", series.name, series.instants, times[0],
           times[series.instants - 1]);
  free(times);
  return isThere;
}

int main(int argc, char** argv) {
  if (argc != 3) return fprintf(stderr, "levels LOG.qtet LEVEL\n"), 2;
  qtet_log* log = qtet_log_create();
  qtet_log_info info;
  if (qtet_log_open_file(log, argv[1]) || qtet_log_get_info(log, sizeof info, &info))
    return failed(log);
  for (uint32_t i = 0; i < info.levels; ++i) {
    qtet_level_info level;
    if (qtet_log_get_level(log, i, sizeof level, &level)) return failed(log);
    printf("level %u: %u tetrahedra, %u vertices, %u boundary triangles, %llu bytes\n", i,
           level.tetrahedra, level.vertices, level.boundaryTriangles,
           (unsigned long long)level.prefixBytes);
  }
  for (uint32_t i = 0; i < qtet_log_series_count(log); ++i)
    if (!printSeries(log, i)) return failed(log);
  if (qtet_log_refine(log,
                      strcmp(argv[2], "full") ? (uint32_t)strtoul(argv[2], NULL, 10) : QTET_FULL))
    return failed(log);

  size_t count = 3 * (size_t)qtet_log_vertex_count(log);
  for (uint32_t f = 0; f < info.fields; ++f)
    count = qtet_log_field_count(log, f) > count ? qtet_log_field_count(log, f) : count;
  double* numbers =
      malloc(count * sizeof *numbers); /* for the points, then for one field after the other */
  if (numbers == NULL || qtet_log_copy_points_double(log, count, numbers))
    return free(numbers), failed(log);
  printf("volume %.9g\n",
         volume(numbers, qtet_log_tetrahedron_count(log), qtet_log_tetrahedra(log)));
  for (uint32_t f = 0; f < info.fields; ++f) {
    qtet_field_info field;
    if (qtet_log_get_field(log, f, sizeof field, &field) ||
        qtet_log_copy_field_double(log, f, count, numbers))
      return free(numbers), failed(log);
    printRange(field.name, numbers, qtet_log_field_count(log, f));
  }
  free(numbers);
  qtet_log_destroy(log);
  return EXIT_SUCCESS;
}
