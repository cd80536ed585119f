#include "simplify/read/check_mesh.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "simplify/clean/hanging_points.h"
#include "simplify/clean/mend_faces.h"
#include "simplify/mesh/cell_faces.h"
#include "simplify/read/read_mesh.h"

namespace qtet {
namespace {

class Checking {
 public:
  explicit Checking(CheckReport& report) : report_(report) {}

  void add(Finding finding) {
    if (finding.found.count > 0 || finding.what.empty())
      report_.findings.push_back(std::move(finding));
  }

  void refuse(const Error& error) {
    add({errorCodeName(error.code), Verdict::kRefused, error.message, "", {}, ""});
  }

  void lookAtCells(const CellMesh& cells) {
    Occurrences repeated;
    for (std::size_t i = 0; i < cells.cells(); ++i) {
      if (cells.types[i] == kTetrahedronCell || cells.types[i] == kPolyhedronCell) continue;
      const std::span<const VertexId> ids = cells.cell(i);
      if (std::set<VertexId>(ids.begin(), ids.end()).size() < ids.size())
        repeated.add(cells.cellId(i));
    }
    add({"collapsedCells", Verdict::kRepaired,
         "cells other than tetrahedra that name a vertex twice: what is left of them is split",
         "cell", repeated, ""});
    for (const MeshField& field : cells.fields) lookAtField(field);
  }

  void lookAtField(const MeshField& field) {
    report_.fields.push_back(field.association + " " + field.name + " (" + field.type + " x " +
                             std::to_string(field.components) + ")");
    Occurrences missing;
    for (std::size_t i = 0; i < field.values.size(); ++i) {
      if (!std::isfinite(field.values[i])) missing.add(i / field.components);
    }
    add({"nonFiniteValues", Verdict::kKept,
         "values of the " + field.association + " field " + field.name +
             " that are NaN or infinite: they become missing values",
         field.association, missing, ""});
  }

  /// The cells that cleaning does not drop, with their own numbers and those of their points.
  void lookAtFaces(const TetMesh& mesh) {
    std::vector<std::uint64_t> names;
    std::vector<Tetrahedron> different;
    for (std::size_t i = 0; i < mesh.tetrahedra.size(); ++i) {
      if (repeatsAVertex(mesh.tetrahedra[i])) continue;
      different.push_back(mesh.tetrahedra[i]);
      names.push_back(i);
    }
    TetMesh sound{mesh.points, {}, {}, {}};
    std::vector<std::uint64_t> soundNames;
    MatchedFaces faces = matchFaces(different);
    for (std::size_t i = 0; i < different.size(); ++i) {
      if (std::ranges::binary_search(faces.duplicates, static_cast<CellId>(i))) continue;
      sound.tetrahedra.push_back(different[i]);
      soundNames.push_back(names[i]);
    }
    if (!faces.duplicates.empty()) faces = matchFaces(sound.tetrahedra);
    lookForOverlaps(faces, soundNames);
    lookForOpenFaces(sound, faces);
  }

  void lookAtSolid(TetMesh& mesh) {
    const Result<CleanReport> clean = cleanMesh(mesh);
    if (clean) {
      addClean(*clean);
      report_.components = clean->components;
      report_.clean = *clean;
      report_.clean.boundary.clear();
    } else if (!isCrowded_) {
      refuse(clean.error());
    }
  }

 private:
  void lookForOverlaps(const MatchedFaces& faces, const std::vector<std::uint64_t>& names) {
    Occurrences crowded;
    for (const CellId cell : faces.crowded) crowded.add(names[cell]);
    isCrowded_ = crowded.count > 0;
    add({"crowdedFaces", Verdict::kRefused, "faces of more than two cells: the cells overlap",
         "tetrahedron", crowded,
         "remove the superfluous cells, or export the parts as files of their own"});
  }

  void lookForOpenFaces(TetMesh& mesh, const MatchedFaces& faces) {
    Occurrences hanging;
    for (const VertexId v : hangingPointsOf(mesh.points, faces.boundaryOf(mesh.tetrahedra)))
      hanging.add(v);
    add({"hangingPoints", Verdict::kKept,
         "T-junctions: boundary points on a boundary face of which they are no corner, where the "
         "mesh is open",
         "point", hanging, "mesh both sides alike if they should hang together"});
    const MendReport mended = mendCrossedFaces(mesh);
    Occurrences crossed;
    crossed.count = mended.mended + mended.left;
    add({"crossedFaces", Verdict::kKept,
         "quadrilaterals that their two cells cut along different diagonals, where the mesh is "
         "open",
         "quadrilateral", crossed, "`weld` 0 cuts them alike"});
  }

  void addClean(const CleanReport& clean) {
    add({"repeatedVertexCells", Verdict::kRepaired, "tetrahedra that name a vertex twice: dropped",
         "tetrahedron", clean.repeatedVertexCells, ""});
    add({"duplicateCells", Verdict::kRepaired,
         "tetrahedra with the vertices of an earlier one: dropped", "tetrahedron",
         clean.duplicateCells, ""});
    add({"reorientedCells", Verdict::kRepaired,
         "tetrahedra whose vertices run the other way round than VTK's: turned", "tetrahedron",
         clean.reorientedCells, ""});
    add({"unusedPoints", Verdict::kRepaired, "points of no cell: dropped", "point",
         clean.unusedPoints, ""});
    add({"flatCells", Verdict::kKept, "tetrahedra without volume", "tetrahedron", clean.flatCells,
         ""});
    add({"invertedCells", Verdict::kKept, "tetrahedra inside out against their neighbours",
         "tetrahedron", clean.invertedCells,
         "fields and volumes are wrong there; mesh the place again"});
    add({"coincidentPoints", Verdict::kKept,
         "points where an earlier one lies: a slit, or parts that do not hang together", "point",
         clean.coincidentPoints, "`weld` 0 joins them"});
    add({"nonManifoldEdges", Verdict::kKept, "boundary edges of more than two boundary faces",
         "point", clean.nonManifoldEdges, ""});
    add({"nonManifoldVertices", Verdict::kKept,
         "boundary points that join several sheets of the boundary", "point",
         clean.nonManifoldVertices, ""});
    Occurrences parts;
    parts.count = clean.components > 1 ? clean.components : 0;
    add({"components", Verdict::kKept, "parts that no face connects", "part", parts, ""});
  }

  CheckReport& report_;
  bool isCrowded_ = false;
};

}  // namespace

const char* verdictName(Verdict verdict) {
  return verdict == Verdict::kRefused    ? "refused"
         : verdict == Verdict::kRepaired ? "repaired"
                                         : "kept";
}

bool CheckReport::refused() const {
  return std::ranges::any_of(
      findings, [](const Finding& finding) { return finding.verdict == Verdict::kRefused; });
}

CheckReport checkMesh(const std::filesystem::path& path, const ReadOptions& options) {
  CheckReport report;
  Checking checking(report);
  Result<CellMesh> cells = readCells(path, options, report.read);
  if (!cells) {
    checking.refuse(cells.error());
    return report;
  }
  checking.lookAtCells(*cells);
  Result<TetMesh> mesh = tetrahedraOf(std::move(*cells), path, options, report.read);
  if (!mesh) {
    checking.refuse(mesh.error());
    return report;
  }
  report.points = mesh->points.size();
  report.tetrahedra = mesh->tetrahedra.size();
  mesh->fields.clear();
  checking.lookAtFaces(*mesh);
  checking.lookAtSolid(*mesh);
  std::vector<Finding> sorted;
  for (const Verdict verdict : {Verdict::kRefused, Verdict::kRepaired, Verdict::kKept})
    std::ranges::copy_if(report.findings, std::back_inserter(sorted),
                         [verdict](const Finding& finding) { return finding.verdict == verdict; });
  report.findings = std::move(sorted);
  return report;
}

}  // namespace qtet
