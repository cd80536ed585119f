// Meshes as files of the kinds that other programs read. .vtu has a header of its own
// (vtu_writer.h), .drc and .glb, too, because they need a lattice (boundary_drc.h, boundary_glb.h).
#pragma once

#include <string_view>

#include "codec/files/file_mesh.h"
#include "proto/byte_sink.h"
#include "proto/error.h"

namespace qtet {

/// Every ending that a mesh can be written with, between blanks.
inline constexpr const char* kWrittenEndings = ".vtu .vtk .msh .obj .glb .drc .usda";

/// Whether this kind of file is made of a mesh on the lattice alone.
[[nodiscard]] bool needsLattice(std::string_view ending);

/// Whether this kind of file holds fields of points, or of cells ("point", "cell"). REQUIRES: one
/// of kWrittenEndings.
[[nodiscard]] bool holdsFields(std::string_view ending, std::string_view association);

/// Choices that the kind of file leaves open.
struct MeshFileOptions {
  bool draco = true;  ///< .glb: triangles and fields in Draco, else as plain numbers
};

/// The mesh as a file of the kind that the ending names. REQUIRES: one of kWrittenEndings, and none
/// that needs the lattice of a mesh in floats. Errors: the writers'.
[[nodiscard]] Result<Bytes> meshFileBytes(const FileMesh& mesh, std::string_view ending);
/// The same into a sink, with one field at a time in memory. Errors: also the sink's.
[[nodiscard]] Status writeMeshFile(const FileMesh& mesh, std::string_view ending,
                                   const ByteSink& sink);
[[nodiscard]] Result<Bytes> meshFileBytes(const LatticeMesh& mesh, std::string_view ending,
                                          const MeshFileOptions& options = {});

/// VTK's legacy format 3.0, binary: an unstructured grid with every field, as VTK, ParaView, meshio
/// and VisIt read it. Errors: bad-input (a name that VTK does not read whole; more than 2^31 - 1
/// points).
[[nodiscard]] Status writeLegacyVtk(const FileMesh& mesh, const ByteSink& sink);

/// Gmsh's MSH 2.2, binary: nodes and tetrahedra numbered from 1 in their order, fields as $NodeData
/// and $ElementData. Gmsh knows 1, 3 and 9 components: others are filled up with zeros to the next
/// of them. Errors: bad-input (a field of more than 9 components; a name that Gmsh does not read
/// whole; more than 2^31 - 1 nodes or cells).
[[nodiscard]] Status writeGmsh(const FileMesh& mesh, const ByteSink& sink);

/// The boundary's triangles as text, without fields.
[[nodiscard]] Bytes objBytes(const FileSurface& surface);

/// OpenUSD text: an Xform `mesh` of two prims. `tetrahedra` is a TetMesh with its surface faces;
/// fields are primvars, of points `vertex`, of cells `uniform`. Its purpose is `guide`, because
/// programs draw `boundary`. That is a Mesh of the boundary's points alone, with their fields, and
/// the first of these as displayColor (viridis over its range, grey where it is missing). Names
/// become USD identifiers (letters, digits and _ stay, everything else becomes _); displayName has
/// them in full. Errors: bad-input (coordinates
/// that its floats do not hold).
[[nodiscard]] Status writeUsda(const FileMesh& mesh, const ByteSink& sink);

}  // namespace qtet
