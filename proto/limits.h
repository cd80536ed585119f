// Every limit on what comes from outside, with its unit and its reason. Compared before anything is
// allocated or looped over.
#pragma once

#include <cstddef>
#include <cstdint>

namespace qtet {

/// Bytes of the manifest in a log, and of that of its later instants. Known errors of 256 fields at
/// the most levels that there may be take 5 MB, at two bytes a figure.
inline constexpr std::uint32_t kMaxManifestBytes = 8u << 20;
/// Bytes of the part of later instants: 8,192 fields in the chunks of a log of 1 GB take 60 MB.
inline constexpr std::uint32_t kMaxLaterBytes = 256u << 20;
/// Figures of fields in a manifest: 1,024 fields at the most levels that there may be, or 8,192 at
/// 512. Decoded, they take 64 MB.
inline constexpr std::uint64_t kMaxFieldFigures = std::uint64_t{4096} * 1024;
/// Chunks of one log: at 16 KB a chunk, a 16 GB log.
inline constexpr std::uint32_t kMaxChunks = 1u << 20;
/// Fields of one log: two quantities at 4,096 instants. Each costs some 7 bytes in every row of the
/// chunk table, and its number fits 16 bits.
inline constexpr std::uint32_t kMaxFields = 8192;
/// Fields that one request of a client names: the instants of a film are asked for in parts.
inline constexpr std::uint32_t kMaxRequestFields = 1024;
/// Instants that one request can ask for behind another: with that one as many as it could name.
inline constexpr std::uint32_t kMaxAhead = kMaxRequestFields - 1;
/// Bytes of a unit: it stands in one line beside a field's name.
inline constexpr std::uint32_t kMaxUnitBytes = 64;
/// Values of a label that have names: a field of more values is no label.
inline constexpr std::uint32_t kMaxLabelNames = 4096;
/// The highest number of a field that a manifest's opening can name, in a byte.
inline constexpr std::uint32_t kMaxOpeningField = 255;
/// Bytes of a name (field, mesh, source file): what file systems allow, and a label on a screen is
/// shorter.
inline constexpr std::uint32_t kMaxNameBytes = 256;
/// Components of one field: a 3x3 tensor has 9; 16 leaves room for a 4x4 matrix.
inline constexpr std::uint32_t kMaxFieldComponents = 16;
/// Blocks behind the last chunk of one log: one a field, and what else the input had. More fields
/// cannot keep their exact values.
inline constexpr std::uint32_t kMaxClosingBlocks = 1024;
/// Levels of one log: 5 % growth a level takes a mesh from 1 to 10^9 cells in 425.
inline constexpr std::uint32_t kMaxLevels = 4096;
/// Vertices, tetrahedra or boundary triangles of one mesh: the entries of all stars, 4 a
/// tetrahedron and 3 a triangle, fit 32 bits.
inline constexpr std::uint32_t kMaxElements = 1u << 29;
/// Bytes of one block: a base mesh of 10^7 cells fits; a decoder's buffer stays below a browser's
/// memory.
inline constexpr std::uint32_t kMaxBlockBytes = 256u << 20;
/// Decisions that one byte of a range coder's stream can hold are fewer: each costs 1/1,420 bit at
/// least (codec/coding/range_coder.h). A value of an adaptive block or a level's figure costs one.
inline constexpr std::uint64_t kMaxDecisionsPerByte = 12'000;
/// Steps that a reader takes for one structure byte: split flags, cells of stars that split,
/// tetrahedra of the base mesh, child bits, levels. Decisions that cost next to nothing would
/// allow ten times as many, which is minutes for a small file. Real logs take up to 14.
inline constexpr std::uint64_t kMaxStepsPerByte = 1024;
/// Structure bytes that a reader takes steps for without having them, so that tiny logs are free:
/// four million steps, a fifth of a second.
inline constexpr std::uint64_t kFreeStepBytes = 4096;
/// Structure bytes that a chunk's counts are checked as if it had in addition.
inline constexpr std::uint64_t kFreeCountBytes = 64;
/// Vertices, tetrahedra or triangles a structure byte for which a refiner makes room before they
/// come. Real logs bring one or two cells a byte.
inline constexpr std::uint64_t kMaxElementsPerByte = 64;
/// Bits of one lattice axis: differences and products of three then fit the exact predicates, and
/// Draco's 2^30.
inline constexpr int kMaxPositionBits = 28;
inline constexpr int kMinPositionBits = 4;
/// Bits of a quantised field value; Draco loses integers above 2^30 without a word.
inline constexpr int kMaxFieldBits = 28;
inline constexpr int kMinFieldBits = 1;
/// Magnitude of any integer given to Draco.
inline constexpr std::int32_t kMaxDracoMagnitude = 1 << 30;
/// Triangles of one link, at coding and at fusing: local ids stay small and a record's work is
/// bounded.
inline constexpr std::uint32_t kMaxLinkTriangles = 4096;

}  // namespace qtet
