#include "simplify/clean/clean_mesh.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "simplify/mesh/cell_faces.h"
#include "simplify/mesh/stopping.h"
#include "simplify/mesh/surface_manifold.h"
#include "simplify/mesh/volume_sign.h"

namespace qtet {
namespace {

/// The mesh while it is cleaned, with what its cells and points were called before.
struct Cleaning {
  TetMesh& mesh;
  CleanReport report;
  std::vector<std::uint64_t> cellNames;
  std::vector<std::uint64_t> pointNames;
  const std::stop_token& stop;
  StopFlag stopped{stop};
};

std::vector<std::uint64_t> countedUp(std::size_t count) {
  std::vector<std::uint64_t> out(count);
  std::iota(out.begin(), out.end(), std::uint64_t{0});
  return out;
}

/// Moves the tuples of the points or cells that are kept to the front.
void keepTuples(MeshField& field, const std::vector<std::uint64_t>& kept) {
  const std::size_t components = field.components;
  assert(kept.size() * components <= field.values.size());
  for (std::size_t i = 0; i < kept.size(); ++i) {
    assert(kept[i] >= i);
    for (std::size_t c = 0; c < components; ++c)
      field.values[i * components + c] = field.values[kept[i] * components + c];
  }
  field.values.resize(kept.size() * components);
}

void dropCells(Cleaning& cleaning, const std::vector<char>& drop) {
  assert(drop.size() == cleaning.mesh.tetrahedra.size());
  assert(cleaning.cellNames.size() == drop.size());
  std::vector<std::uint64_t> kept;
  for (std::size_t i = 0; i < cleaning.mesh.tetrahedra.size(); ++i) {
    if (drop[i]) continue;
    cleaning.mesh.tetrahedra[kept.size()] = cleaning.mesh.tetrahedra[i];
    cleaning.cellNames[kept.size()] = cleaning.cellNames[i];
    kept.push_back(i);
  }
  cleaning.mesh.tetrahedra.resize(kept.size());
  cleaning.cellNames.resize(kept.size());
  for (MeshField& field : cleaning.mesh.fields) {
    if (isCellField(field)) keepTuples(field, kept);
  }
}

void dropRepeatedVertexCells(Cleaning& cleaning) {
  const std::vector<Tetrahedron>& cells = cleaning.mesh.tetrahedra;
  std::vector<char> drop(cells.size(), 0);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!repeatsAVertex(cells[i])) continue;
    drop[i] = 1;
    cleaning.report.repeatedVertexCells.add(i);
  }
  if (cleaning.report.repeatedVertexCells.count > 0) dropCells(cleaning, drop);
}

/// The faces of the cells that are left once each set of vertices has one.
MatchedFaces dropDuplicateCells(Cleaning& cleaning) {
  const std::vector<Tetrahedron>& cells = cleaning.mesh.tetrahedra;
  MatchedFaces faces = matchFaces(cells, cleaning.stopped.get());
  throwIfStopped(cleaning.stop);
  if (faces.duplicates.empty()) return faces;
  std::vector<char> drop(cells.size(), 0);
  for (const CellId cell : faces.duplicates) {
    drop[cell] = 1;
    cleaning.report.duplicateCells.add(cleaning.cellNames[cell]);
  }
  dropCells(cleaning, drop);
  faces = matchFaces(cells, cleaning.stopped.get());
  throwIfStopped(cleaning.stop);
  return faces;
}

Status checkCrowds(const Cleaning& cleaning, const MatchedFaces& faces) {
  if (faces.crowded.empty()) return {};
  std::vector<std::uint64_t> cells;
  for (const CellId cell : faces.firstCrowd) cells.push_back(cleaning.cellNames[cell]);
  return overlap(cells);
}

double volume6Of(const TetMesh& mesh, const Tetrahedron& t) {
  return roundedVolume6(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]);
}

int signOf(const TetMesh& mesh, const Tetrahedron& t) {
  return volumeSign(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]);
}

enum : char { kUnseen = 0, kAsStored = 1, kTurned = 2 };

/// Gives every cell of `first`'s component a sense that agrees with `first`'s, and returns them.
/// Errors: bad-input.
Result<std::vector<CellId>> orientComponent(CellId first, const Cleaning& cleaning,
                                            const std::vector<CellNeighbours>& neighbours,
                                            std::vector<char>& sense) {
  assert(sense[first] == kUnseen);
  std::vector<CellId> component{first};
  sense[first] = kAsStored;
  for (std::size_t next = 0; next < component.size(); ++next) {
    if (next % kLookEvery == 0) throwIfStopped(cleaning.stop);
    const CellId cell = component[next];
    for (std::size_t i = 0; i < 4; ++i) {
      const CellId other = neighbours[cell].across[i];
      if (other == kNoCell) continue;
      const bool disagrees = neighbours[cell].disagrees & (1u << i);
      const char wanted = (sense[cell] == kAsStored) != disagrees ? kAsStored : kTurned;
      if (sense[other] == kUnseen) {
        sense[other] = wanted;
        component.push_back(other);
      } else if (sense[other] != wanted) {
        return ringWithoutInside(cleaning.cellNames[cell], cleaning.cellNames[other]);
      }
    }
  }
  return component;
}

/// Turns a component's cells so that they agree and the larger volume is positive.
void turn(Cleaning& cleaning, const std::vector<CellId>& component, const std::vector<char>& sense,
          std::vector<char>& turned) {
  double volume = 0;
  for (const CellId cell : component) {
    const double own = volume6Of(cleaning.mesh, cleaning.mesh.tetrahedra[cell]);
    volume += sense[cell] == kTurned ? -own : own;
  }
  for (const CellId cell : component) turned[cell] = (sense[cell] == kTurned) != (volume < 0);
}

Status orient(Cleaning& cleaning, MatchedFaces& faces) {
  std::vector<Tetrahedron>& cells = cleaning.mesh.tetrahedra;
  assert(faces.neighbours.size() == cells.size());
  std::vector<char> sense(cells.size(), kUnseen), turned(cells.size(), 0);
  for (CellId first = 0; first < cells.size(); ++first) {
    if (sense[first] != kUnseen) continue;
    const auto component = orientComponent(first, cleaning, faces.neighbours, sense);
    if (!component) return std::unexpected(component.error());
    turn(cleaning, *component, sense, turned);
    ++cleaning.report.components;
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i % kLookEvery == 0) throwIfStopped(cleaning.stop);
    if (turned[i]) {
      std::swap(cells[i][2], cells[i][3]);
      std::swap(faces.neighbours[i].across[2], faces.neighbours[i].across[3]);
      cleaning.report.reorientedCells.add(cleaning.cellNames[i]);
    }
    const int sign = signOf(cleaning.mesh, cells[i]);
    if (sign == 0) cleaning.report.flatCells.add(cleaning.cellNames[i]);
    if (sign < 0) cleaning.report.invertedCells.add(cleaning.cellNames[i]);
  }
  return {};
}

void dropUnusedPoints(Cleaning& cleaning) {
  TetMesh& mesh = cleaning.mesh;
  std::vector<VertexId> renumbered(mesh.points.size(), kGhost);
  for (const Tetrahedron& cell : mesh.tetrahedra) {
    for (const VertexId v : cell) renumbered[v] = 0;
  }
  std::vector<std::uint64_t> kept;
  for (std::size_t v = 0; v < renumbered.size(); ++v) {
    if (renumbered[v] == kGhost) {
      cleaning.report.unusedPoints.add(v);
    } else {
      renumbered[v] = static_cast<VertexId>(kept.size());
      kept.push_back(v);
    }
  }
  if (cleaning.report.unusedPoints.count == 0) return;

  for (Tetrahedron& cell : mesh.tetrahedra) {
    for (VertexId& v : cell) v = renumbered[v];
  }
  for (std::size_t i = 0; i < kept.size(); ++i) mesh.points[i] = mesh.points[kept[i]];
  assert(kept.size() + cleaning.report.unusedPoints.count == mesh.points.size());
  mesh.points.resize(kept.size());
  for (MeshField& field : mesh.fields) {
    if (!isCellField(field)) keepTuples(field, kept);
  }
  cleaning.pointNames = std::move(kept);
}

void reportCoincidentPoints(Cleaning& cleaning) {
  const std::vector<Position>& points = cleaning.mesh.points;
  std::vector<VertexId> order(points.size());
  std::iota(order.begin(), order.end(), VertexId{0});
  std::sort(order.begin(), order.end(), [&](VertexId a, VertexId b) {
    return points[a] != points[b] ? points[a] < points[b] : a < b;
  });
  std::vector<VertexId> later;
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (points[order[i]] == points[order[i - 1]]) later.push_back(order[i]);
  }
  std::sort(later.begin(), later.end());
  for (const VertexId v : later) cleaning.report.coincidentPoints.add(cleaning.pointNames[v]);
}

void reportNonManifoldParts(Cleaning& cleaning) {
  const NonManifoldParts parts = nonManifoldPartsOf(cleaning.report.boundary);
  for (const auto& [low, high] : parts.edges) {
    cleaning.report.nonManifoldEdges.add(cleaning.pointNames[low]);
    if (cleaning.report.nonManifoldEdges.count <= Occurrences::kShown)
      cleaning.report.nonManifoldEdgeEnds.push_back(cleaning.pointNames[high]);
  }
  for (const VertexId v : parts.vertices)
    cleaning.report.nonManifoldVertices.add(cleaning.pointNames[v]);
}

void reportExtent(Cleaning& cleaning) {
  const TetMesh& mesh = cleaning.mesh;
  CleanReport& report = cleaning.report;
  for (const Tetrahedron& cell : mesh.tetrahedra) report.volume += volume6Of(mesh, cell) / 6;
  assert(!mesh.points.empty());
  report.box = {mesh.points.front(), mesh.points.front()};
  for (const Position& p : mesh.points)
    for (std::size_t a = 0; a < 3; ++a) {
      report.box[0][a] = std::min(report.box[0][a], p[a]);
      report.box[1][a] = std::max(report.box[1][a], p[a]);
    }
}

Result<CleanReport> clean(TetMesh& mesh, const std::stop_token& stop) {
  Cleaning cleaning{
      mesh, {}, countedUp(mesh.tetrahedra.size()), countedUp(mesh.points.size()), stop};
  dropRepeatedVertexCells(cleaning);
  MatchedFaces faces = dropDuplicateCells(cleaning);
  if (mesh.tetrahedra.empty()) {
    return fail(ErrorCode::kBadInput,
                "no cell has four different vertices, so there is nothing to simplify; export the "
                "volume mesh again");
  }
  if (Status checked = checkCrowds(cleaning, faces); !checked)
    return std::unexpected(checked.error());
  if (Status oriented = orient(cleaning, faces); !oriented)
    return std::unexpected(oriented.error());
  dropUnusedPoints(cleaning);
  cleaning.report.boundary = faces.boundaryOf(mesh.tetrahedra);
  assert(cleaning.cellNames.size() == mesh.tetrahedra.size());
  assert(cleaning.pointNames.size() == mesh.points.size());
  reportCoincidentPoints(cleaning);
  reportNonManifoldParts(cleaning);
  reportExtent(cleaning);
  return std::move(cleaning.report);
}

/// "WHAT: 77 (cells 3, 6, ...)"
std::string sentence(const Occurrences& found, const std::string& what, const std::string& kind) {
  std::string out =
      what + ": " + std::to_string(found.count) + " (" + kind + (found.count == 1 ? " " : "s ");
  for (std::size_t i = 0; i < found.first.size(); ++i)
    out += (i ? ", " : "") + std::to_string(found.first[i]);
  return out + (found.count > found.first.size() ? ", ...)" : ")");
}

}  // namespace

std::unexpected<Error> overlap(std::span<const std::uint64_t> cells) {
  std::string list;
  for (const std::uint64_t cell : cells) list += (list.empty() ? "" : ", ") + std::to_string(cell);
  return fail(ErrorCode::kBadInput,
              std::to_string(cells.size()) + " cells (" + list +
                  ") share one face, so they overlap; at most two can. Remove the superfluous "
                  "ones, or export the parts as separate files");
}

std::unexpected<Error> ringWithoutInside(std::uint64_t cell, std::uint64_t other) {
  return fail(ErrorCode::kBadInput,
              "cells " + std::to_string(cell) + " and " + std::to_string(other) +
                  " close a ring of cells that cannot be given one inside and outside (as a "
                  "Moebius strip); such a mesh is not a solid in space: look for wrongly merged "
                  "points near these cells");
}

std::vector<std::string> CleanReport::sentences() const {
  std::vector<std::string> out;
  const auto say = [&out](const Occurrences& found, const char* what, const char* kind) {
    if (found.count > 0) out.push_back(sentence(found, what, kind));
  };
  say(repeatedVertexCells, "cells that name a vertex twice, dropped", "cell");
  say(duplicateCells, "cells with the vertices of an earlier one, dropped", "cell");
  say(reorientedCells, "cells turned to the orientation of VTK", "cell");
  say(flatCells, "cells without volume, kept", "cell");
  say(invertedCells, "cells inside out against their neighbours, kept", "cell");
  say(unusedPoints, "points of no cell, dropped", "point");
  say(coincidentPoints, "points where an earlier one lies, kept apart", "point");
  say(nonManifoldEdges, "boundary edges that join more than two boundary faces", "lower end");
  say(nonManifoldVertices, "boundary points that join several sheets of the boundary", "point");
  if (components > 1) out.push_back("parts that no face connects: " + std::to_string(components));
  return out;
}

Result<CleanReport> cleanMesh(TetMesh& mesh, const std::stop_token& stop) {
  return orCancelled([&] { return clean(mesh, stop); });
}

}  // namespace qtet
