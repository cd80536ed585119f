// Limits of the kinds of file on fields: how many, of how many components, with names how long.
// A program that reads such a file keeps these in a byte or in a buffer of fixed size.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "codec/files/file_mesh.h"
#include "codec/mesh/mesh.h"
#include "proto/error.h"

namespace qtet {

/// Attributes of a Draco mesh beside its positions. Draco writes the number of each, from 0, as a
/// signed byte. From 129 attributes on its files cannot be read, and from 256 on its encoder writes
/// beyond its memory.
inline constexpr std::size_t kMaxDracoAttributes = 128;
/// Components of a field in a .msh: Gmsh shows scalars, vectors of 3 and tensors of 9.
inline constexpr std::uint32_t kMaxGmshComponents = 9;
/// Bytes of a field's name in a .msh: Gmsh reads lines of 255 bytes, with two quotes and the end of
/// the line.
inline constexpr std::size_t kMaxGmshNameBytes = 252;
/// Bytes of a field's name in a .vtk, encoded as there (vtkName): VTK reads words of 255 bytes.
inline constexpr std::size_t kMaxVtkNameBytes = 255;

/// A field, as far as kinds of file limit it.
struct FieldOutline {
  std::string_view name;
  std::uint32_t components = 1;
  bool ofCells = false;
};

/// They look at the mesh's names.
[[nodiscard]] std::vector<FieldOutline> outlinesOf(const LatticeMesh& mesh);
[[nodiscard]] std::vector<FieldOutline> outlinesOf(const FileMesh& mesh);

/// Whether a file of the kind `ending` (of kWrittenEndings; .glb with Draco) can hold these fields.
/// The writers ask it first, and a server before it makes a level. Errors: bad-input, with the
/// figure, the limit and what to do.
[[nodiscard]] Status canHold(std::string_view ending, const std::vector<FieldOutline>& fields);

}  // namespace qtet
