/* Makes the log of a mesh in arrays, as `qtet simplify` does, for C and for every language that
 * calls C. C99.
 *
 *   qtet_input_mesh mesh = {0};
 *   mesh.points = xyz, mesh.pointType = QTET_FLOAT64, mesh.pointCount = 729;
 *   mesh.tetrahedra = ids, mesh.idType = QTET_UINT32, mesh.tetrahedronCount = 3072;
 *
 *   qtet_simplified* made = qtet_simplified_create();
 *   if (qtet_simplify(made, sizeof mesh, &mesh, 0, NULL) ||
 *       qtet_simplified_write(made, "part.qtet"))
 *     puts(qtet_simplified_error(made));
 *   qtet_simplified_destroy(made);
 *
 * Errors, threads, pointers and structs are as in qtet.h. A message names an option as the program
 * `qtet` does: --target-ratio is targetRatio here. The same mesh and options give the same bytes
 * here and there. */
#ifndef QTET_SIMPLIFY_H
#define QTET_SIMPLIFY_H

#include "codec/api/qtet.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- what goes in */

/* Types of numbers in arrays. */
enum {
  QTET_FLOAT32 = 1,
  QTET_FLOAT64 = 2,
  QTET_INT8 = 3,
  QTET_INT16 = 4,
  QTET_INT32 = 5,
  QTET_INT64 = 6,
  QTET_UINT8 = 7,
  QTET_UINT16 = 8,
  QTET_UINT32 = 9,
  QTET_UINT64 = 10
};

typedef struct {
  const char* name;     /* 1 to 256 bytes of UTF-8; other fields of its association have others */
  uint32_t association; /* QTET_POINT or QTET_CELL */
  uint32_t type;        /* QTET_FLOAT32 ... QTET_UINT64; integers below 2^53 in magnitude */
  uint32_t components;  /* 1 .. QTET_MAX_COMPONENTS */
  uint32_t reserved;    /* 0 */
  /* `components` numbers a point or tetrahedron, those of one together. A float that is not finite
   * is a missing value. */
  const void* values;
} qtet_input_field;

typedef struct {
  const void* points; /* x, y and z of each, finite */
  uint64_t pointCount;
  /* Four points each; which way round does not matter. Flat and repeated ones are dealt with as
   * `qtet check` tells. */
  const void* tetrahedra;
  uint64_t tetrahedronCount;
  uint32_t pointType; /* QTET_FLOAT32 or QTET_FLOAT64 */
  uint32_t idType;    /* QTET_INT32, QTET_INT64, QTET_UINT32 or QTET_UINT64 */
  const qtet_input_field* fields;
  uint32_t fieldCount;
  uint32_t fieldBytes; /* sizeof(qtet_input_field) */
} qtet_input_mesh;

/* ---- how */

enum { QTET_ALGORITHM_QTET = 0, QTET_ALGORITHM_PAPER = 1 };
enum { QTET_PLACEMENT_AUTO = 0, QTET_PLACEMENT_OPTIMAL = 1, QTET_PLACEMENT_VERTEX = 2 };
enum { QTET_MEASURE_NONE = 0, QTET_MEASURE_LEVELS = 1, QTET_MEASURE_ALL = 2 };
enum { QTET_CODEC_LIFTED = 0, QTET_CODEC_DRACO = 1, QTET_CODEC_ADAPTIVE = 2 };

/* In the order of doing, but for QTET_STAGE_REDUCE, which is before QTET_STAGE_SIMPLIFY. It,
 * QTET_STAGE_MEASURE and QTET_STAGE_KEEP only where they are asked for. */
enum {
  QTET_STAGE_CLEAN = 0,
  QTET_STAGE_QUANTISE = 1,
  QTET_STAGE_SIMPLIFY = 2,
  QTET_STAGE_MEASURE = 3,
  QTET_STAGE_ENCODE = 4,
  QTET_STAGE_KEEP = 5,
  QTET_STAGE_REDUCE = 6 /* since 0.5 */
};

/* Called about ten times a second, in the thread that called qtet_simplify. It receives the stage
 * in hand, and how much of it is done, 0 to 1. Anything but 0 ends the work soon, with
 * QTET_CANCELLED. */
typedef int (*qtet_progress)(void* user, uint32_t stage, double fraction);

/* A field and what is said of it. */
typedef struct {
  const char* name;
  double value;
} qtet_named_number;

/* How far the values of a field may be from the input's, at the last level, each component by
 * itself. The name may be that of a series, for all its instants. "all" means every float field
 * that no other bound names. */
typedef struct {
  const char* name;
  double value;     /* above 0, finite */
  const char* unit; /* "%": per cent of the field's range; null or "": the field's unit */
} qtet_error_bound;

/* qtet_simplify_defaults sets all of them. `qtet simplify --help` says more of each. */
typedef struct {
  double targetRatio;       /* the base mesh's tetrahedra over the input's; NaN: baseError chooses,
                             * from 0.01 and 500 tetrahedra upwards */
  double boundaryWeight;    /* beside the fields; NaN: chosen by the mesh */
  double shapeWeight;       /* 0.5 */
  double envelopeTolerance; /* over the diagonal of the mesh's box; NaN: 0.005 */
  uint32_t positionBits;    /* of the lattice, an axis: 16 */
  uint32_t fieldBits;       /* of a float field's values: 12 */
  uint32_t algorithm;       /* QTET_ALGORITHM_QTET */
  uint32_t placement;       /* QTET_PLACEMENT_AUTO */
  uint32_t measure;         /* QTET_MEASURE_LEVELS: the known error of each level */
  uint32_t valueCodec;      /* QTET_CODEC_LIFTED */
  uint32_t keepOrder;       /* 1: the log keeps the input's numbering; 0 */
  uint32_t lossless;        /* 1: it keeps the input's own numbers; 0 */
  uint32_t exactCoarse;    /* Since 0.4. 1: coarse levels keep the best values, for more bytes; 0 */
  uint32_t threads;        /* as many as there are processors at most; 1. The log is the same */
  double maxBoundaryError; /* over the diagonal; NaN: no bound */
  const qtet_named_number* maxFieldErrors; /* rms over the field's range */
  const qtet_named_number* fieldWeights;   /* of point fields; others count 1. Without, the
                                            * smoother a field the more, 8 at most */
  uint32_t maxFieldErrorCount, fieldWeightCount;
  const char* regions;    /* a cell field whose values keep their topology, or null */
  const char* source;     /* the name that the log calls its input, or null */
  qtet_progress progress; /* or null */
  void* user;             /* handed to it */
  /* Since 0.3. 1: the cell field OriginalCellId (int32, not negative) is kept for the last level
   * alone instead of a stream, and the numbering with it; 0 */
  uint32_t originalIds;
  /* Since 0.3. The base mesh's tetrahedra, instead of targetRatio; 0: as that says */
  uint32_t baseCells;
  /* Since 0.3. The base mesh is the coarsest level whose boundary is within this fraction of the
   * diagonal. Its volume is within twice this fraction. Since 0.4 fields of floats are, too, as far
   * as 24 kB and a quarter of the tetrahedra allow. NaN: 0.01, and 30,000 tetrahedra or 64 kB at
   * most, where no other member chooses the base mesh */
  double baseError;
  /* Since 0.4. 1: each series NAME@TIME gives the fields NAME_average, NAME_minimum, NAME_maximum
   * and NAME_stddev, its statistics over all instants; 0 */
  uint32_t timeStatistics;
  /* Since 0.4. Cell fields of integers that are labels, such as materials, and what their
   * interfaces count; 0 leaves them out. Others: a sixteenth of the boundary's weight */
  uint32_t labelWeightCount;
  const qtet_named_number* labelWeights;
  /* Since 0.4. Fields that take the step and the bits of a bound instead of fieldBits */
  const qtet_error_bound* errors;
  uint32_t errorCount;
  /* Since 0.5, experimental. The last level has so many tetrahedra at most, to which the mesh is
   * reduced before; 0: it is the input's mesh */
  uint32_t finest;
} qtet_simplify_options;

QTET_API qtet_status qtet_simplify_defaults(size_t optionsBytes, qtet_simplify_options* options);

/* ---- making a log */

/* A log that was made, or why there is none. */
typedef struct qtet_simplified qtet_simplified;

/* Null only if memory is short. */
QTET_API qtet_simplified* qtet_simplified_create(void);
/* Gives the log's memory back; null is allowed. */
QTET_API void qtet_simplified_destroy(qtet_simplified* made);
/* Text of the last failure, "" before the first; until the next call that fails. */
QTET_API const char* qtet_simplified_error(const qtet_simplified* made);

/* Makes the log of a mesh; `options` null: the defaults. Keeps no pointer. If it fails, there is no
 * log. QTET_BAD_INPUT: a mesh that cannot be simplified, with the reason in the text. */
QTET_API qtet_status qtet_simplify(qtet_simplified* made, size_t meshBytes,
                                   const qtet_input_mesh* mesh, size_t optionsBytes,
                                   const qtet_simplify_options* options);

/* The log and its length; until the next qtet_simplify or destroy. Null and 0 without one.
 * qtet_log_open_memory opens it. */
QTET_API const void* qtet_simplified_log(const qtet_simplified* made, size_t* bytes);
/* Writes the log as a file, whole or not at all: after a failure what was there is there still. */
QTET_API qtet_status qtet_simplified_write(qtet_simplified* made, const char* path);
/* Changes to the mesh and unusual things about it, a line each; "" if there are none. A line that
 * begins with "warning: " says that the base mesh has lost much of the shape, and which options
 * help. Valid until the next qtet_simplify or destroy. */
QTET_API const char* qtet_simplified_notes(const qtet_simplified* made);

#ifdef __cplusplus
}
#endif

#endif
