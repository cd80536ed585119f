// Selects the fields of a file that were asked for, and the cells.
#pragma once

#include <filesystem>
#include <span>

#include "simplify/read/options/read_options.h"
#include "simplify/split/cell_mesh.h"

namespace qtet {

/// Whether a field of a file may be one of those asked for, before all of the file's fields are
/// known. It goes by field_key.h; a series is also meant where one of its steps is asked for
/// (NAME@TIME of NAME).
[[nodiscard]] bool isMeant(const FieldNames& names, const std::string& association,
                           const FieldName& name);

/// Leaves the fields asked for, in the order asked, each once. Errors: not-found (no field of that
/// name; the message lists what there is), limit-exceeded (more than kMaxFields).
[[nodiscard]] Status selectFields(const FieldNames& names, const std::filesystem::path& path,
                                  const std::vector<std::string>& otherFields,
                                  std::vector<MeshField>& fields);

/// Leaves the cells within the threshold. Errors: not-found (no such field among those read),
/// bad-input (no cell is left).
[[nodiscard]] Status applyThreshold(const Threshold& threshold, const std::filesystem::path& path,
                                    CellMesh& mesh);

/// Integers of 2^53 or more in magnitude, which a double cannot distinguish from their neighbours.
/// Where all fields are meant, one that holds them is left out, with a note. Errors: bad-input
/// (such a field is asked for by name).
[[nodiscard]] Status leaveOutWideIntegers(const FieldNames& names,
                                          const std::filesystem::path& path,
                                          std::vector<MeshField>& fields,
                                          std::vector<std::string>& notes);

/// Fewer values may all differ though they number nothing, such as the materials of a few cells.
/// Numbers of so few things take some hundred bytes at most.
inline constexpr std::size_t kFewestNumbers = 64;

/// Where all fields are meant, leaves out those that number points or cells. VTK's filters add
/// vtkOriginalPointIds and vtkOriginalCellIds. Others are fields of one integer each, at least
/// kFewestNumbers in all, without names, no two of which are the same. One note names
/// all such fields. They are the larger part of a log, and nobody looks at them.
void leaveOutNumbers(const FieldNames& names, CellMesh& mesh, std::vector<std::string>& notes);

/// int32 where it holds all values, else int64: for files that do not say how wide their integers
/// are.
[[nodiscard]] const char* integerTypeOf(std::span<const double> values);

/// Whether a log can hold the name: not empty, at most kMaxNameBytes bytes, UTF-8 (FORMAT.md,
/// "Manifest").
[[nodiscard]] bool isStorableName(const std::string& name);

/// Gives a field that has no such name, or that of an earlier field of its association, one of its
/// own, and notes it.
void nameFields(std::vector<MeshField>& fields, std::vector<std::string>& notes);

}  // namespace qtet
