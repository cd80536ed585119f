// The XML of VTK's grids (.vtu, .vts, .vtr, .vti): the counts of their pieces, and where each array
// lies.
// https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "proto/error.h"
#include "simplify/read/vtu/vtu_file.h"

namespace qtet {

enum class NumberType : std::uint8_t {
  kInt8,
  kUInt8,
  kInt16,
  kUInt16,
  kInt32,
  kUInt32,
  kInt64,
  kUInt64,
  kFloat32,
  kFloat64,
  kBit,   ///< numbers in single bits
  kText,  ///< no numbers
};
/// The bytes of one number; 0 for bits and texts.
[[nodiscard]] std::uint32_t bytesOf(NumberType type);

enum class VtuCompressor : std::uint8_t { kNone, kZlib, kLz4, kLzma };

/// One <DataArray> or <Array>.
struct VtuArray {
  enum class Place : std::uint8_t { kAscii, kInline, kAppended };

  std::string name;
  std::string parent;  ///< the element that it stands in: "Cells"
  NumberType type = NumberType::kText;
  std::uint32_t components = 1;  ///< at least 1
  bool isIdType = false;         ///< VTK keeps such in 64 bits, whatever the file has
  Place place = Place::kAscii;
  std::uint64_t begin = 0;  ///< of its text in the file; of appended data: behind the underscore
  std::uint64_t end = 0;    ///< of its text in the file
  std::uint64_t line = 0;   ///< of its tag, from 1

  /// "line 12: the array connectivity of <Cells>"
  [[nodiscard]] std::string called() const;
  /// Its Name, or that of its element.
  [[nodiscard]] std::string shortName() const { return name.empty() ? parent : name; }
};

/// <PointData> or <CellData>.
struct VtuFields {
  std::vector<VtuArray> arrays;
  std::string globalIds, degrees, weights;  ///< names of the arrays with that role; empty: none
};

enum class GridKind : std::uint8_t { kUnstructured, kStructured, kRectilinear, kImage };

struct VtuPiece {
  std::uint64_t points = 0, cells = 0;
  std::uint64_t line = 0;                 ///< of its tag, from 1
  std::array<std::int32_t, 6> extent{};   ///< of other grids: first and last point of each axis
  std::optional<VtuArray> coordinates;    ///< the only array of <Points>
  std::vector<VtuArray> axisCoordinates;  ///< of <Coordinates>: the three of a rectilinear grid
  std::vector<VtuArray> cellArrays;       ///< of <Cells>
  VtuFields pointFields, cellFields;
};

struct VtuDocument {
  GridKind kind = GridKind::kUnstructured;
  /// An image's first point, the distances of neighbours, and its axes as columns, row by row.
  std::array<double, 3> origin{0, 0, 0}, spacing{1, 1, 1};
  std::array<double, 9> direction{1, 0, 0, 0, 1, 0, 0, 0, 1};
  bool isBigEndian = false;
  std::uint32_t wordBytes = 4;  ///< of the numbers in front of binary data
  VtuCompressor compressor = VtuCompressor::kNone;
  bool hasOldHexahedra = false;  ///< their nodes stand in the order of VTK 8 (old_hexahedra.h)
  bool hasTimeSteps = false;     ///< several steps in one file, of which arrays tell theirs
  std::optional<VtuArray> time;  ///< of <FieldData>: the time of this one step
  /// Arrays of <FieldData> such as "Material=steel" (vtu_label_names.h).
  std::vector<VtuArray> labelNames;
  bool appendedIsBase64 = true;
  std::optional<std::uint64_t> appendedBegin;  ///< the first byte of appended data
  std::vector<VtuPiece> pieces;                ///< at least one
};

/// Reads the XML up to appended data. Errors: bad-input (no such XML, with the line; an attribute
/// whose value is none; a count beyond 2^63 - 1), limit-exceeded (kMax... in the .cpp), truncated,
/// io. Declarations of document types are refused, since they declare entities.
[[nodiscard]] Result<VtuDocument> readVtuDocument(const VtuFile& file);

}  // namespace qtet
