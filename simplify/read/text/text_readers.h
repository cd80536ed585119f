// Our own readers of formats of text or plain bytes. Their results are still to be checked
// (checkCellMesh); counts are held against the bytes that remain before anything is allocated.
// `patience` and the file's size say how long they may take (ReadingTime).
// Errors: io; truncated, bad-input (also: no time is left), with the line, in binary files the
// byte.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>

#include "simplify/read/options/read_options.h"
#include "simplify/split/cell_mesh.h"

namespace qtet {

/// Gmsh 2.2 and 4.1, text and binary (little-endian): nodes, elements, NodeData and ElementData. A
/// field given at several times has the steps that `time` means (time_steps.h). The first physical
/// group of a volume is the cell field gmsh:physical. Nodes keep the file's order, cells that of
/// the volume elements. https://gmsh.info/doc/texinfo/gmsh.html#File-formats
[[nodiscard]] Result<CellMesh> readGmsh(const std::filesystem::path& path, const std::string& time,
                                        ReadReport& report,
                                        std::chrono::seconds patience = kReadPatience);

/// Medit .mesh, and .meshb of versions 1 to 4: vertices, tetrahedra, hexahedra, prisms, pyramids,
/// second-degree tetrahedra; references other than 0 are the fields medit:ref.
/// https://www.ljll.fr/frey/publications/RT-0253.pdf, and libMeshb's keywords.
[[nodiscard]] Result<CellMesh> readMedit(const std::filesystem::path& path, ReadReport& report,
                                         std::chrono::seconds patience = kReadPatience);

/// TetGen NAME.node and NAME.ele (either is given, both are read), numbered from 0 or 1: attributes
/// are the point fields attribute-I and the cell fields attribute-I. A ten-node tetrahedron is read
/// by its corners: TetGen sets the other nodes on straight edges.
/// https://wias-berlin.de/software/tetgen/fformats.html
[[nodiscard]] Result<CellMesh> readTetgen(const std::filesystem::path& path, ReadReport& report,
                                          std::chrono::seconds patience = kReadPatience);

/// I-DEAS universal files (.unv) as Salome and Gmsh write them: datasets 2411 and 781 of nodes,
/// 2412 and 780 of elements. Groups of elements that do not overlap are the label Group
/// (labelOfSets); results at nodes of dataset 2414 are point fields. Others are left out, with a
/// note.
/// https://www.ceas3.uc.edu/sdrluff (datasets by number)
[[nodiscard]] Result<CellMesh> readUnv(const std::filesystem::path& path, ReadReport& report,
                                       std::chrono::seconds patience = kReadPatience);

/// Legacy VTK files of unstructured grids, text and binary, with both ways to list cells: points,
/// cells, and the arrays that `fields` means. nullopt: VTK has to read the file. It holds another
/// data set, polyhedra, or arrays of bits, texts, colours and the like.
/// https://docs.vtk.org/en/latest/vtk_file_formats/vtk_legacy_file_format.html
[[nodiscard]] Result<std::optional<CellMesh>> readLegacyVtk(
    const std::filesystem::path& path, const FieldNames& fields, ReadReport& report,
    std::chrono::seconds patience = kReadPatience);

/// SU2 of three dimensions and one zone; the markers are skipped.
/// https://su2code.github.io/docs_v7/Mesh-File/
[[nodiscard]] Result<CellMesh> readSu2(const std::filesystem::path& path, ReadReport& report,
                                       std::chrono::seconds patience = kReadPatience);

}  // namespace qtet
