// The codec as C functions for WebAssembly (and any other foreign caller). One refiner a module
// instance; addresses are byte offsets into the module's memory and stay valid until the next call
// that applies something. Functions that can fail return 0 for success or 1 + ErrorCode, and
// qtet_error() then gives the text.
#pragma once

#include <cstdint>

extern "C" {

/// Memory for bytes that the caller hands in; freed by qtet_free.
void* qtet_alloc(std::uint32_t bytes);
void qtet_free(void* memory);

/// Starts with the log whose header, manifest and table are `head` (LogIndex::headBytesOf gives
/// their size). A coarser level is made by a new instance that is given the same blocks up to it:
/// an instance's memory never shrinks.
int qtet_open(const std::uint8_t* head, std::uint32_t bytes);
/// Bytes of the part of later instants, the last ones of the file; 0 if there is none, or once it
/// is read.
std::uint32_t qtet_later_bytes();
/// Brings the fields of this part; before that the log is as without them.
int qtet_read_later(const std::uint8_t* part, std::uint32_t bytes);
/// NUL-terminated text of the last failure.
const char* qtet_error();

std::uint32_t qtet_chunk_count();
std::uint32_t qtet_level_count();
/// Decodes the end of a manifest, the figures of all levels and of `fields` fields
/// (codec/coding/level_columns.h); `errors` is a KnownErrors, 0 to 1. qtet_level_numbers() then
/// gives them until the next such call.
int qtet_level_columns(const std::uint8_t* bytes, std::uint32_t size, std::uint32_t errors,
                       std::uint32_t fields);
const std::uint32_t* qtet_level_numbers();
/// File offset (a double: exact up to 2^53), size and tuples of a block; part 0 structure, 1
/// positions, 2 + f field f.
double qtet_block_offset(std::uint32_t chunk, std::uint32_t part);
std::uint32_t qtet_block_size(std::uint32_t chunk, std::uint32_t part);
/// Tuples in a value block. Positions and point fields have equally many; a cell field has one for
/// each tetrahedron that the chunk brings.
std::uint32_t qtet_block_values(std::uint32_t chunk, std::uint32_t part);
/// The kind of element that a field's values belong to: 0 points, 1 tetrahedra (Association of
/// codec/log/log_index.h).
std::uint32_t qtet_field_association(std::uint32_t field);
/// The fields that a field is predicted from (RECORDS.md, "Series"): how many, and each of them.
std::uint32_t qtet_field_parents(std::uint32_t field);
std::uint32_t qtet_field_parent(std::uint32_t field, std::uint32_t parent);
/// CodecId of a block.
std::uint32_t qtet_block_codec(std::uint32_t chunk, std::uint32_t part);
/// Tetrahedra, vertices and boundary triangles that a chunk brings; null where there is no such
/// chunk. Valid until the next such call.
const std::uint32_t* qtet_chunk_brings(std::uint32_t chunk);
/// Compares a block's bytes with its CRC-32C.
int qtet_check_block(std::uint32_t chunk, std::uint32_t part, const std::uint8_t* bytes,
                     std::uint32_t size);

/// Refiner::apply; `symbols` are the positions block's `count` integers (3 a tuple) as the Draco
/// decoder gave them, `digits` the `digitBytes` bytes behind the Draco stream
/// (codec/coding/value_digits.h). For an adaptive block, pass no symbols, and the whole block as
/// digits.
int qtet_apply(std::uint32_t chunk, const std::uint8_t* structure, std::uint32_t size,
               const std::int32_t* symbols, std::uint32_t count, const std::uint8_t* digits,
               std::uint32_t digitBytes);
/// Refiner::applyField, with the field's block in the same two parts.
int qtet_apply_field(std::uint32_t field, std::uint32_t chunk, const std::int32_t* symbols,
                     std::uint32_t count, const std::uint8_t* digits, std::uint32_t digitBytes);

std::uint32_t qtet_chunks_applied();
std::uint32_t qtet_field_chunks_applied(std::uint32_t field);
std::uint32_t qtet_level();
std::uint32_t qtet_vertex_count();
std::uint32_t qtet_tetrahedron_count();
std::uint32_t qtet_boundary_count();
const std::int32_t* qtet_points();       ///< 3 a vertex, lattice coordinates
const std::uint32_t* qtet_tetrahedra();  ///< 4 a tetrahedron
const std::uint32_t* qtet_boundary();    ///< 3 a triangle, counter-clockwise seen from outside
/// The tetrahedron across the face opposite to a corner below 4; 0xFFFFFFFF at the boundary, and
/// where there is no such tetrahedron.
std::uint32_t qtet_across(std::uint32_t tetrahedron, std::uint32_t corner);
/// Components a vertex or, of a cell field, a tetrahedron; 0 when it has no chunk yet.
const std::int32_t* qtet_field(std::uint32_t field);
/// Writes the 32 bytes of the mesh digest.
void qtet_digest(std::uint8_t* out);
}
