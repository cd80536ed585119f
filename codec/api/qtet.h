/* qtet's logs for C and for every language that calls C: what a log holds, and its mesh at any
 * level. C99.
 *
 *   qtet_log* log = qtet_log_create();
 *   if (qtet_log_open_file(log, "part.qtet") || qtet_log_refine(log, QTET_FULL))
 *     puts(qtet_log_error(log));
 *   ... qtet_log_tetrahedra(log) ...
 *   qtet_log_destroy(log);
 *
 * Errors    A function that can fail returns a qtet_status; qtet_log_error then says what failed,
 *           where, and what to do. No exception leaves.
 * Threads   One thread at a time may use a qtet_log; different ones have nothing in common and need
 *           no lock.
 * Pointers  Returned memory belongs to the qtet_log; each function says how long it stays valid.
 *           No function keeps a pointer that the caller passes.
 * Structs   The caller passes sizeof his struct first: later versions append members, and fill no
 *           more than he has.
 * Sizes     Arrays are packed in slots of codec/FORMAT.md: a slot's number never changes while a
 *           mesh is refined.
 *
 * The browser has functions of its own (codec/api/wasm_api.h in the sources). There a page fetches
 * blocks and Draco decodes them outside, so a module is one refiner that is fed integers. Here a
 * log is a file or memory, and everything is decoded inside. No name is in both. */
#ifndef QTET_H
#define QTET_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define QTET_API __attribute__((visibility("default")))
#else
#define QTET_API
#endif

/* The version of this header. Below 1.0 a new minor version may break callers, and the library's
 * SOVERSION then grows. */
#define QTET_VERSION_MAJOR 0
#define QTET_VERSION_MINOR 4
#define QTET_VERSION_PATCH 0
#define QTET_VERSION_NUMBER \
  (QTET_VERSION_MAJOR * 10000 + QTET_VERSION_MINOR * 100 + QTET_VERSION_PATCH)

/* The level behind every log's last one: the whole mesh. */
#define QTET_FULL 0xFFFFFFFFu
/* qtet_log_level before anything was refined. */
#define QTET_NO_LEVEL 0xFFFFFFFFu
#define QTET_MAX_COMPONENTS 16
#define QTET_DIGEST_BYTES 32

#ifdef __cplusplus
extern "C" {
#endif

/* 0 is success. Numbers never change their meaning; later versions may add some. */
typedef int32_t qtet_status;
enum {
  QTET_OK = 0,
  QTET_TRUNCATED = 1,      /* the bytes end before what they promise */
  QTET_BAD_MAGIC = 2,      /* not a qtet log at all */
  QTET_BAD_VERSION = 3,    /* a log of a version that this library cannot read */
  QTET_BAD_CHECKSUM = 4,   /* bytes that were changed after they had been written */
  QTET_BAD_VALUE = 5,      /* a value outside its range, or two that contradict each other */
  QTET_LIMIT_EXCEEDED = 6, /* a count or size that no log may have */
  QTET_BAD_CODEC = 7,      /* a block that its own decoder refuses */
  QTET_BAD_ORDER = 8,      /* a chunk that needs another one first */
  QTET_NOT_FOUND = 9,      /* no such level or field, or an error that was not measured */
  QTET_BAD_INPUT = 10,     /* a mesh that cannot be simplified: qtet_simplify.h */
  QTET_IO = 11,            /* the operating system refused to open or read: a missing file, too */
  QTET_CANCELLED = 12,     /* the caller asked to stop: qtet_simplify.h */
  QTET_BAD_ARGUMENT = 100, /* null, not a number, or an array or struct too small */
  QTET_NO_LOG = 101,       /* nothing is open */
  QTET_NO_MESH = 102,      /* nothing is refined: qtet_log_refine first */
  QTET_OUT_OF_MEMORY = 103,
  QTET_INTERNAL = 104 /* a defect of the library; please report it */
};

/* The kind of element that a field's values belong to. */
enum { QTET_POINT = 0, QTET_CELL = 1 };

typedef struct qtet_log qtet_log;

/* ---- the library */

/* QTET_VERSION_NUMBER of the library that runs. */
QTET_API uint32_t qtet_version(void);
/* "0.4.0"; for ever. */
QTET_API const char* qtet_version_text(void);
/* "bad-checksum", as in codec/FORMAT.md; "unknown" for a number that is none. For ever. */
QTET_API const char* qtet_status_name(qtet_status status);

/* ---- opening */

/* Null only if memory is short. */
QTET_API qtet_log* qtet_log_create(void);
/* Ends every pointer of this log; null is allowed. */
QTET_API void qtet_log_destroy(qtet_log* log);
/* Text of the last failure, "" before the first; until the next call that fails. */
QTET_API const char* qtet_log_error(const qtet_log* log);

/* Both close what was open, also if they fail, and check header, manifest and chunk table; blocks
 * are checked when they are used. The file is mapped into memory: as long as it is open, nobody may
 * write into it or shorten it (a new file of its name does no harm). */
QTET_API qtet_status qtet_log_open_file(qtet_log* log, const char* path);
/* Copies the bytes, so they may go at once. */
QTET_API qtet_status qtet_log_open_memory(qtet_log* log, size_t bytes, const void* data);
/* Compares every block with its checksum. */
QTET_API qtet_status qtet_log_verify(qtet_log* log);

/* ---- what a log holds: the strings stay until the next open or destroy */

typedef struct {
  uint32_t versionMajor, versionMinor; /* of the format */
  uint64_t bytes;                      /* of the whole log */
  uint32_t chunks;
  uint32_t levels; /* 0 is the base mesh, levels - 1 the whole one */
  uint32_t fields;
  uint32_t latticeBits;
  double latticeStep; /* position = origin + step * lattice point */
  double latticeOrigin[3];
  const char* digest;    /* SHA-256 of the log, 64 lower-case hexadecimal digits */
  const char* source;    /* file name of the mesh that it was made from */
  const char* generator; /* "qtet 0.4.0" */
  const char* timeUnit;  /* Since 0.4: of the times of instants; "": unknown */
} qtet_log_info;

typedef struct {
  uint32_t components;  /* 1 .. QTET_MAX_COMPONENTS */
  uint32_t association; /* QTET_POINT or QTET_CELL (a tetrahedron) */
  uint32_t bits;        /* integers lie in [0, 2^bits) */
  uint32_t reserved;    /* 0 */
  double step;          /* value of component c = minimum[c] + step * integer */
  double minimum[QTET_MAX_COMPONENTS];
  double range[2]; /* of the values, or of the magnitude if components > 1, in the whole mesh */
  uint64_t bytes;  /* of its blocks in the log */
  const char* name;
  const char* type; /* of the input: float32, float64, int8 ... uint64 */
  const char* unit; /* Since 0.4; "": unknown */
  /* Since 0.4. "": no label. Else {"1": "steel", "2": "oil"}: the values that have names, as JSON
  */
  const char* labels;
  /* Since 0.4. The most that a value of the last level, as a number of `type`, may differ from the
   * input's: half a step and rounding. 0: none does */
  double largestRoundingError;
} qtet_field_info;

typedef struct {
  uint32_t tetrahedra, vertices, boundaryTriangles;
  uint32_t hasError;       /* 1: the members below and qtet_log_field_error are known, else 0 */
  uint64_t prefixBytes;    /* of the log's front that holds the level */
  double boundaryDistance; /* the larger max below: the Hausdorff distance */
  /* From the original's boundary to the level's, over the diagonal of the original's box. */
  double toLevelMean, toLevelMax;
  double toOriginalMean, toOriginalMax; /* and back */
  double volumeKept;                    /* the level's volume over the original's */
  /* Since 0.3: the part of the original that is not covered, and what is covered outside of it,
   * over the original's volume. */
  double volumeLost, volumeGained;
} qtet_level_info;

QTET_API qtet_status qtet_log_get_info(qtet_log* log, size_t infoBytes, qtet_log_info* info);
QTET_API qtet_status qtet_log_get_field(qtet_log* log, uint32_t field, size_t infoBytes,
                                        qtet_field_info* info);
QTET_API qtet_status qtet_log_get_level(qtet_log* log, uint32_t level, size_t infoBytes,
                                        qtet_level_info* info);
/* The field that a name means: of points, else of cells; "cell:NAME" and "point:NAME" say which. */
QTET_API qtet_status qtet_log_find_field(qtet_log* log, const char* name, uint32_t* field);
/* Known error of a field at a level, over the field's range. The rms of a label is the
 * share of the volume that has another one, its max 1 or 0. QTET_NOT_FOUND if it was not measured.
 */
QTET_API qtet_status qtet_log_field_error(qtet_log* log, uint32_t level, uint32_t field,
                                          double* rms, double* max);

/* ---- series: fields NAME@TIME that agree in association, components and type, two and more */

typedef struct {
  uint32_t association; /* QTET_POINT or QTET_CELL */
  uint32_t instants;    /* 2 and more */
  const char* name;     /* without @TIME; a series of points and one of cells may share it */
} qtet_series_info;

/* Since 0.4. In the order of their first fields; 0 without a log. */
QTET_API uint32_t qtet_log_series_count(const qtet_log* log);
QTET_API qtet_status qtet_log_get_series(qtet_log* log, uint32_t series, size_t infoBytes,
                                         qtet_series_info* info);
/* Since 0.4. Writes a series' times, ascending, and the number of each time's field. The caller's
 * arrays have `count` entries; either may be null. */
QTET_API qtet_status qtet_log_copy_series(qtet_log* log, uint32_t series, size_t count,
                                          double* times, uint32_t* fields);

/* ---- choosing a level */

/* The finest level within a bound: of at most `most` tetrahedra, or decodable from the log's first
 * `most` bytes. 0 if there is none. */
QTET_API qtet_status qtet_log_level_of_tetrahedra(qtet_log* log, uint64_t most, uint32_t* level);
QTET_API qtet_status qtet_log_level_of_bytes(qtet_log* log, uint64_t most, uint32_t* level);
/* The coarsest level that is known to be within a bound: of boundaryDistance, or of a field's rms
 * error. QTET_NOT_FOUND if the log does not state it. */
QTET_API qtet_status qtet_log_level_of_boundary_error(qtet_log* log, double bound, uint32_t* level);
QTET_API qtet_status qtet_log_level_of_field_error(qtet_log* log, uint32_t field, double bound,
                                                   uint32_t* level);

/* ---- the mesh */

/* Makes the mesh that of `level`, or the whole one (QTET_FULL); levels may be asked for in any
 * order. A finer level than the present one costs only the levels between. A coarser level costs
 * decoding from the front, and so does a finer one if the present level ends inside a chunk.
 * Fields are decoded when somebody asks for them. Ends the pointers below. If it fails, there is
 * no mesh. */
QTET_API qtet_status qtet_log_refine(qtet_log* log, uint32_t level);
/* The mesh's level, QTET_NO_LEVEL without a mesh; its sizes, 0 without one. */
QTET_API uint32_t qtet_log_level(const qtet_log* log);
QTET_API uint32_t qtet_log_vertex_count(const qtet_log* log);
QTET_API uint32_t qtet_log_tetrahedron_count(const qtet_log* log);
QTET_API uint32_t qtet_log_boundary_count(const qtet_log* log);

/* 3 integers a vertex; until the next refine, open or destroy. Null without a mesh. */
QTET_API const int32_t* qtet_log_lattice_points(const qtet_log* log);
/* 4 vertices a tetrahedron, oriented as VTK's; until the next refine, open or destroy. Null without
 * a mesh. */
QTET_API const uint32_t* qtet_log_tetrahedra(const qtet_log* log);
/* 3 vertices a triangle, counter-clockwise seen from outside; until the next refine, open or
 * destroy. Null without a mesh. */
QTET_API const uint32_t* qtet_log_boundary(const qtet_log* log);

/* Writes 3 numbers a vertex, in the mesh's own units, to the caller's array of `count` numbers. */
QTET_API qtet_status qtet_log_copy_points_double(qtet_log* log, size_t count, double* points);
QTET_API qtet_status qtet_log_copy_points_float(qtet_log* log, size_t count, float* points);

/* Numbers in a field at the present level: components times vertices or tetrahedra; 0 without such
 * a field or a mesh. */
QTET_API size_t qtet_log_field_count(const qtet_log* log, uint32_t field);
/* Writes a field's values, all components of a vertex or tetrahedron together, to the caller's
 * array of `count` numbers; NaN where a value is missing. */
QTET_API qtet_status qtet_log_copy_field_double(qtet_log* log, uint32_t field, size_t count,
                                                double* values);
QTET_API qtet_status qtet_log_copy_field_float(qtet_log* log, uint32_t field, size_t count,
                                               float* values);
/* The integers themselves, qtet_log_field_count of them; until the next refine, open or destroy. */
QTET_API qtet_status qtet_log_field_integers(qtet_log* log, uint32_t field,
                                             const int32_t** integers);

/* Writes the QTET_DIGEST_BYTES bytes of the mesh digest: equal if and only if points, tetrahedra
 * and boundary are. */
QTET_API qtet_status qtet_log_mesh_digest(qtet_log* log, uint8_t* digest);

#ifdef __cplusplus
}
#endif

#endif
