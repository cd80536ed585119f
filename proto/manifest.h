// The manifest: what a log holds, for people and programs (FORMAT.md, "Manifest"). Decoding needs
// only the chunk table. codec/log/log_manifest.h reads it out of a log; as JSON it goes out by the
// server and the tool.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proto/error.h"
#include "proto/field_name.h"
#include "proto/label_names.h"
#include "proto/level_error.h"
#include "proto/series.h"

namespace qtet {

/// In the order of their numbers in a log.
inline constexpr std::array<std::string_view, 10> kFieldTypes{
    "float32", "float64", "int8", "int16", "int32", "int64", "uint8", "uint16", "uint32", "uint64"};

struct ManifestField {
  FieldName name;
  std::uint32_t components = 1;
  std::string type;                   ///< one of kFieldTypes
  std::string association = "point";  ///< point or cell
  int bits = 0;                       ///< integers lie in [0, 2^bits)
  double step = 1;                    ///< value = minimum[c] + step * integer
  std::vector<double> minimum;
  std::array<double, 2> range{};  ///< of the values, or of the magnitude where components > 1
  bool hasMissing = false;        ///< some values are missing: NaN
};

/// Whether it is a cell field of one component and of integers that are stored as they are.
[[nodiscard]] bool mayBeLabel(const ManifestField& field);

struct ManifestLevel {
  std::uint32_t level = 0;
  std::uint32_t tetrahedra = 0;
  std::uint32_t vertices = 0;
  std::uint32_t boundaryTriangles = 0;
  std::uint32_t chunk = 0;  ///< the level is complete once this chunk is applied
  /// Against the original, where it was measured.
  std::optional<LevelError> error = std::nullopt;
};

/// A box where the original's cells are small, if it is small against the mesh. Low corner, high
/// corner, in 2^-16 of the lattice's span; each low end is below the high one.
using Focus = std::array<std::uint16_t, 6>;

/// The first picture that shows something.
struct Opening {
  std::uint8_t field = 0;  ///< that colours it
  /// The axis across which the mesh is cut open in the middle, 0..2.
  std::optional<std::uint8_t> cut = std::nullopt;

  [[nodiscard]] bool operator==(const Opening&) const = default;
};

/// Cell fields of one integer that say what a cell is, such as its material. By a field's name
/// without @TIME; what values are called, as far as that is known.
using Labels = std::map<std::string, LabelNames, std::less<>>;
/// By a field's name without @TIME; that of times by the empty name. None is empty.
using Units = std::map<std::string, std::string, std::less<>>;

/// The mesh that the last level was reduced from before the log was made.
struct OriginalSize {
  std::uint64_t tetrahedra = 0, vertices = 0;

  [[nodiscard]] bool operator==(const OriginalSize&) const = default;
};

struct Manifest {
  std::string generator;
  std::string source;  ///< file name of the input, without its folder
  int latticeBits = 0;
  double latticeStep = 1;
  std::array<double, 3> latticeOrigin{};
  std::optional<Focus> focus = std::nullopt;
  /// None: the first field on the boundary.
  std::optional<Opening> opening = std::nullopt;
  std::vector<ManifestField> fields;
  /// Those of `fields`, of two instants and more. Made with the manifest (log_manifest.h).
  std::vector<Series> series{};
  Units units;
  Labels labels;
  /// None: the last level is the input's mesh.
  std::optional<OriginalSize> original = std::nullopt;
  std::vector<ManifestLevel> levels;  ///< level 0 = base mesh
};

/// The unique name of field `f`: its name, or "cell:NAME" for a cell field if a point field has the
/// same name.
[[nodiscard]] std::string fieldKey(const Manifest& manifest, std::size_t f);
/// The key of the field that a viewer shows first. Empty without fields.
[[nodiscard]] std::string firstField(const Manifest& manifest);
/// The one field that `key` means (field_key.h).
[[nodiscard]] std::optional<std::uint32_t> fieldOfKey(const Manifest& manifest,
                                                      std::string_view key);
/// not-found: no field is meant by `key`. The message has the keys of those that are there.
[[nodiscard]] Error noSuchField(const Manifest& manifest, std::string_view key);

/// The unit of the field of this name or of its series: that of the manifest, else the "K" of a
/// name "T [K]". Empty: unknown.
[[nodiscard]] std::string_view unitOf(const Manifest& manifest, const FieldName& name);
/// The names of a label's values, perhaps none of them; null: field `f` is no label.
[[nodiscard]] const LabelNames* labelNamesOf(const Manifest& manifest, std::size_t f);
/// By field, whether it is a label.
[[nodiscard]] std::vector<bool> labelsAmong(const Manifest& manifest);
/// That of the times of instants. Empty: unknown.
[[nodiscard]] std::string_view timeUnit(const Manifest& manifest);

/// The corners of the manifest's focus in the mesh's own coordinates. REQUIRES: there is one.
[[nodiscard]] std::array<double, 6> focusCorners(const Manifest& manifest);

[[nodiscard]] std::string manifestToJson(const Manifest& manifest);

}  // namespace qtet
