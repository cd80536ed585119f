// The options of reading a mesh file, and the report about it.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "simplify/read/options/series_report.h"
#include "simplify/split/split_cells.h"

namespace qtet {

/// The fields to read: all (nullopt: those of points first), or those that these names mean
/// (proto/field_key.h), in this order.
using FieldNames = std::optional<std::vector<std::string>>;

/// Only cells where the field lies within [low, high]. For a cell field its own value counts, for a
/// point field those of all of its vertices.
struct Threshold {
  std::string field;
  double low = 0, high = 0;
};

/// The default of `readSeconds`.
inline constexpr std::chrono::seconds kReadPatience{60};

/// The files of a series that no file lists, as withListedFiles gives them (listed_files.h).
struct ListedFiles {
  std::vector<std::filesystem::path> files;  ///< empty: the path alone says which
  std::vector<double> times;                 ///< one a file; empty: the files themselves say them
  std::string note;                          ///< where the times come from
  bool isChecked = false;
};

/// Pairs of names of blocks, the lesser name first.
using BlockPairs = std::set<std::pair<std::string, std::string>>;

struct ReadOptions {
  FieldNames fields;
  CurvedCells curved = CurvedCells::kSplit;
  std::optional<double> weld;  ///< points within this distance become one (weld_points.h)
  bool joinPieces = true;      ///< at the points that they share (join_pieces.h)
  /// Whose points stay apart; nullopt: the file's first step says it (readMesh).
  std::optional<BlockPairs> apartBlocks{};
  /// Whether cells with points of their own are joined (own_points.h); nullopt: values say it.
  std::optional<bool> joinsOwnPoints{};
  bool keepsNumbers = false;  ///< also fields that only number things (leaveOutNumbers)
  /// Adds the cell field kOriginalCellField (split_cells.h) to those asked for by name; naming it
  /// does the same.
  bool originalIds = false;
  std::optional<Threshold> threshold;
  /// A step's, "first", "last", "all", FROM:TO:EVERY, or several times between commas.
  std::string time = "last";
  /// Fields are called NAME@TIME also where one step is read, if the file knows its time.
  bool namesTime = false;
  /// The points move at other steps: these get displacements even if none of them moves.
  bool moves = false;
  /// The file's kind as an ending without dot; empty: as its name says.
  std::string format;
  /// The Q file beside a PLOT3D grid; empty: the file is no PLOT3D grid.
  std::string plot3dSolution;
  bool plot3d = false;
  ListedFiles listed{};
  /// How long a foreign reader may read nothing before it is given up (watch_process.h). One of
  /// ours may take so long beside what the file's size allows (reading_time.h).
  std::chrono::seconds patience = kReadPatience;
};

/// Reports what was in the file and is not in the mesh, and what was done to it; `notes` says it in
/// sentences for people.
struct ReadReport {
  std::uint64_t ignoredCells = 0;          ///< of dimension 0, 1 or 2
  std::vector<std::string> ignoredFields;  ///< texts, more than kMaxFieldComponents components
  SplitReport split;
  std::uint64_t pieces = 0;        ///< with points of their own, in the step that was read last
  std::uint64_t joinedPoints = 0;  ///< points of pieces, joined with one of an earlier piece
  bool joinedByIds = false;        ///< they were found by ids that hold for all pieces
  bool blocksMeet = false;         ///< blocks with different names share points
  BlockPairs differingBlocks{};    ///< they share points, at which their values differ
  /// The pairs that stay apart, where blocks meet; nullopt: none do, or nobody has decided.
  std::optional<BlockPairs> apartBlocks{};
  std::optional<bool> ownPointsJoined{};  ///< where cells have points of their own
  std::uint64_t weldedPoints = 0;         ///< joined with an earlier one
  std::uint64_t mendedFaces = 0;  ///< quadrilaterals that both sides cut alike after welding
  /// All that the file has, ascending; empty: it has none, or its reader takes all steps at once.
  std::vector<double> times;
  std::string motion{};               ///< of moving points: the series that has how far (joinSteps)
  SeriesReport series{};              ///< on all steps that were read as one mesh
  std::vector<std::string> labels{};  ///< the cell fields made of labels (cell_labels.h)
  std::vector<std::string> notes;     ///< also VTK's warnings
  std::vector<std::string> warnings{};  ///< what spoils the result, and the cure
};

}  // namespace qtet
