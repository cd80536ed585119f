// Reads a grid in VTK's XML (.vtu, .vts, .vtr, .vti) without VTK. No file harms the process: every
// count is compared with the bytes that remain before anything is allocated.
#pragma once

#include "simplify/read/options/read_options.h"
#include "simplify/read/vtu/vtu_document.h"
#include "simplify/split/cell_mesh.h"

namespace qtet {

/// The document's pieces one after the other: visible volume cells that are no other piece's
/// (ghosts), points as they are, the fields meant by `fields`. Arrays of other fields are not
/// decoded. Cells of lower dimension are counted in the report, fields of texts or too many
/// components noted. Ids are narrowed, not checked (checkCellMesh). Errors: bad-input (arrays that
/// are missing, contradict each other or the counts, or cannot be decoded; the message names the
/// array and its line), truncated, io, and bad-input where an array does not fit in memory.
/// REQUIRES: a document of this file, without time steps. One that is not unstructured has one
/// piece.
[[nodiscard]] Result<CellMesh> readVtu(const VtuFile& file, const VtuDocument& document,
                                       const FieldNames& fields, ReadReport& report);

/// MeshField::type of an array's numbers.
[[nodiscard]] std::string fieldTypeOf(const VtuArray& array);
/// GridArray::isOfTheShape of an array among `fields`.
[[nodiscard]] bool isOfTheShape(const VtuFields& fields, const VtuArray& array);

/// The time of the document's one step; nullopt: it has none. Errors: those of readReals.
[[nodiscard]] Result<std::optional<double>> readVtuTime(const VtuFile& file,
                                                        const VtuDocument& document);

}  // namespace qtet
