/* An example of a program that makes a log with the library. It takes the whole mesh of another
 * log, with its fields, and simplifies it again.
 *   simplify LOG.qtet NEW.qtet NAME RATIO     NAME: what the new log calls its input */
#include <qtet/qtet_simplify.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAX_FIELDS 16

static int failed(const char* why) {
  fprintf(stderr, "simplify: %s\n", why);
  return EXIT_FAILURE;
}

/* About ten times a second; anything but 0 would end the work. */
static int tell(void* user, uint32_t stage, double fraction) {
  fprintf((FILE*)user, "stage %u: %d %%\n", stage, (int)(100 * fraction));
  return 0;
}

/* The values of a field in an array of its own; the name belongs to the log. */
static int read_field(qtet_log* log, uint32_t f, qtet_input_field* out) {
  qtet_field_info info;
  size_t count = qtet_log_field_count(log, f);
  const int32_t* integers;
  double* values = malloc((count + 1) * sizeof *values); /* room for any type */
  if (values == NULL || qtet_log_get_field(log, f, sizeof info, &info)) return 1;
  memset(out, 0, sizeof *out);
  out->name = info.name;
  out->association = info.association;
  out->components = info.components;
  out->values = values;
  if (strcmp(info.type, "uint8") == 0) { /* labels, for example */
    if (qtet_log_field_integers(log, f, &integers)) return 1;
    for (size_t i = 0; i < count; ++i)
      ((uint8_t*)values)[i] = (uint8_t)(info.minimum[i % info.components] + integers[i]);
    out->type = QTET_UINT8;
    return 0;
  }
  out->type = strcmp(info.type, "float32") ? QTET_FLOAT64 : QTET_FLOAT32;
  return out->type == QTET_FLOAT32 ? qtet_log_copy_field_float(log, f, count, (float*)values)
                                   : qtet_log_copy_field_double(log, f, count, values);
}

int main(int argc, char** argv) {
  qtet_log* log = qtet_log_create();
  qtet_simplified* made = qtet_simplified_create();
  qtet_log_info info;
  qtet_input_field fields[MAX_FIELDS];
  qtet_input_mesh mesh = {0};
  qtet_simplify_options options;
  if (argc != 5) return failed("LOG.qtet NEW.qtet NAME RATIO");
  if (qtet_log_open_file(log, argv[1]) || qtet_log_get_info(log, sizeof info, &info) ||
      qtet_log_refine(log, QTET_FULL))
    return failed(qtet_log_error(log));
  if (info.fields > MAX_FIELDS) return failed("too many fields");

  size_t count = 3 * (size_t)qtet_log_vertex_count(log);
  double* points = malloc(count * sizeof *points);
  if (points == NULL || qtet_log_copy_points_double(log, count, points))
    return failed(qtet_log_error(log));
  for (uint32_t f = 0; f < info.fields; ++f)
    if (read_field(log, f, &fields[f])) return failed(qtet_log_error(log));
  mesh.points = points, mesh.pointType = QTET_FLOAT64;
  mesh.pointCount = qtet_log_vertex_count(log);
  mesh.tetrahedra = qtet_log_tetrahedra(log), mesh.idType = QTET_UINT32;
  mesh.tetrahedronCount = qtet_log_tetrahedron_count(log);
  mesh.fields = fields, mesh.fieldCount = info.fields, mesh.fieldBytes = sizeof fields[0];

  if (qtet_simplify_defaults(sizeof options, &options)) return failed("another qtet_simplify.h");
  options.targetRatio = strtod(argv[4], NULL);
  options.source = argv[3];
  options.progress = tell, options.user = stderr;
  if (qtet_simplify(made, sizeof mesh, &mesh, sizeof options, &options) ||
      qtet_simplified_write(made, argv[2]))
    return failed(qtet_simplified_error(made));
  printf("%s", qtet_simplified_notes(made));

  for (uint32_t f = 0; f < info.fields; ++f) free((void*)fields[f].values);
  free(points);
  qtet_log_destroy(log);
  qtet_simplified_destroy(made);
  return EXIT_SUCCESS;
}
