// Fields of mesh files for a log that is there already (SERIES.md, "Fields added later").
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "codec/refine/log_edit.h"
#include "codec/refine/log_history.h"
#include "simplify/clean/field_scales.h"
#include "simplify/clean/value_bounds.h"
#include "simplify/log/fused_values.h"
#include "simplify/log/lift_fields.h"
#include "simplify/log/match_mesh.h"
#include "simplify/measure/measure_error.h"
#include "simplify/mesh/tet_mesh.h"
#include "simplify/series/series.h"

namespace qtet {

/// Threads that may be asked for.
inline constexpr int kMaxAddingThreads = 256;

struct AddFieldsOptions {
  int fieldBits = 12;
  ValueBounds errors{};             ///< of fields that take the bits of a bound instead
  Effort effort = Effort::kLevels;  ///< for measuring, where the log knows the errors of its levels
  int threads = 1;
  /// The log's fields that stay, as withFields takes them; all without it. Nothing is predicted
  /// from another one.
  std::optional<std::vector<std::uint32_t>> kept{};
  /// Instants take the steps of those of their series that the log has, and have room below and
  /// above their range. Instants that stay stand alone: no other is predicted from them.
  bool scalesOfOthers = false;
  std::function<void(double)> progress{};  ///< fraction done, of make() and of each add()
};

struct AddedFields {
  /// The log's fields that stay, as withFields takes them. Instants of an unfinished window are
  /// coded again, among `fields`, when it has become full.
  std::vector<std::uint32_t> kept;
  std::vector<NewField> fields;
  std::vector<std::size_t> again;  ///< numbers of such instants in `fields`
  std::vector<std::string> notes;
  std::vector<std::string> warnings;  ///< instants that lead far away from the others
};

class FieldAdder {
 public:
  /// Decodes the geometry of the log, which must outlive it. Errors: all that decoding gives.
  [[nodiscard]] static Result<FieldAdder> make(const LogFile& log, const AddFieldsOptions& options);

  /// Adds the fields of `mesh` as blocks for the log, whose last level must be the mesh; its
  /// geometry stays as it is. Instants NAME@TIME are coded as differences to each other, and to the
  /// last earlier instant of their scale. Where they fill the log's last window, that is coded as
  /// one. Only this mesh's values are held in memory, those of such a window, and those of such
  /// earlier instants. A field takes the scale of its series as far as that holds its bound.
  /// Errors: matchMesh's, quantiseField's, bad-value (a position off the log's
  /// lattice), limit-exceeded (too many fields), and all that decoding gives; after one the adder
  /// is of no use. REQUIRES: a mesh that cleanMesh has passed,
  /// bounds that are finite and above 0.
  [[nodiscard]] Status add(const TetMesh& mesh);
  /// Instants that fill the window of the longest series: add() does best with so many at first,
  /// and with kWindow each time thereafter. 1 to kWindow + 1.
  [[nodiscard]] std::size_t roomInWindow() const;
  /// All that was added. REQUIRES: called once and last.
  [[nodiscard]] AddedFields take();

 private:
  /// A field on its way into the log.
  struct Item {
    FieldInfo info;
    std::vector<std::int32_t> values;   // of the history's elements, a number everywhere
    std::vector<std::uint8_t> missing;  // of the last level's elements; empty if none is
    std::vector<FieldError> errors;     // one a level
    bool wasThere = false;              // an instant that is coded again
    bool isLabel = false;
  };
  /// A scale of a series, of the fewest bits that an instant has.
  struct Scale {
    FieldInfo info;
    std::size_t instants = 0;
  };
  /// An instant that the log keeps or that was added: `number` as NewField::prediction counts.
  struct Instant {
    double time = 0;
    std::size_t number = 0;
    FieldInfo info;
  };
  struct SeriesState {
    std::vector<Scale> scales;
    std::vector<Instant> instants;  // by time
    bool isExtended = false;        // instants have come to it
  };
  /// The fields of the history while new ones are coded: those that the log has come first.
  struct Numbers {
    std::vector<std::size_t> all;   // as NewField::prediction counts
    std::vector<std::size_t> rows;  // depths of those that the log has
  };
  using SeriesKey = std::pair<std::string, std::string>;  // association, name

  FieldAdder(const LogFile& log, AddFieldsOptions options, Manifest manifest,
             std::unique_ptr<LogHistory> history);
  [[nodiscard]] Status matchTo(const TetMesh& mesh);
  [[nodiscard]] bool isKnownLabel(const FieldInfo& info) const;
  [[nodiscard]] bool isLabel(const std::vector<Tetrahedron>& tetrahedra, const FieldInfo& info,
                             const std::vector<std::int32_t>& values) const;
  [[nodiscard]] Result<std::vector<Item>> itemsOf(const TetMesh& mesh);
  [[nodiscard]] Status addParents(const std::vector<Item>& items, Numbers& numbers);
  [[nodiscard]] Result<LevelErrors> measure(std::span<const Item> items, FieldReplay& replay);
  [[nodiscard]] Result<std::vector<LiftingRules>> lift(std::span<Item> items);
  [[nodiscard]] Result<std::vector<LiftingRules>> liftMeasured(std::span<const Item> items,
                                                               LevelErrors& errors,
                                                               const FieldReplay& replay);
  void complete(std::vector<Item>& items, Numbers& numbers);
  [[nodiscard]] Status encode(const Numbers& numbers, std::span<const LiftingRules> rules);
  [[nodiscard]] Status code(std::vector<Item> items);
  [[nodiscard]] SeriesState* seriesOf(std::string_view association, const FieldName& name);
  void keepScale(FieldInfo info, bool stays);
  void keepInstant(const FieldInfo& info, double time, std::size_t number);
  [[nodiscard]] static const FieldInfo* scaleOf(const SeriesState& series);
  [[nodiscard]] static std::optional<FieldInfo> commonScale(
      const SeriesState& series, std::span<const MeshField* const> fields);
  [[nodiscard]] std::map<const SeriesState*, std::optional<FieldInfo>> commonScales(
      const TetMesh& mesh);
  [[nodiscard]] Result<QuantisedField> quantised(const MeshField& field, const FieldScale& own,
                                                 const std::optional<FieldInfo>& scale,
                                                 const std::optional<ValueBound>& bound);
  [[nodiscard]] double rangeOfSeries(const MeshField& field, const FieldScale& own,
                                     const FieldInfo& scale);
  [[nodiscard]] Result<QuantisedField> quantisedBeside(const MeshField& field,
                                                       const FieldScale& own,
                                                       const FieldInfo& scale,
                                                       const std::optional<ValueBound>& bound);
  [[nodiscard]] const Instant* parentOf(const FieldInfo& info);
  [[nodiscard]] Status takeUnfinished(std::vector<Item>& items);
  [[nodiscard]] Status takeBack(std::span<const Instant> instants, std::vector<Item>& items);
  [[nodiscard]] Result<Item> itemOf(const Instant& instant) const;
  void forgetValues();

  const LogFile& log_;
  AddFieldsOptions options_;
  Manifest manifest_;
  std::set<std::string, std::less<>> labels_;  // of the log and those added, without @TIME
  std::unique_ptr<LogHistory> history_;
  std::vector<Tetrahedron> finest_;  // the last level's cells
  TetMesh matched_;                  // the mesh that `match_` is of, without fields
  MeshMatch match_;
  std::map<SeriesKey, SeriesState> series_;
  std::map<std::size_t, std::vector<std::int32_t>> values_;  // completed, of parents by number
  OutlyingInstants outlying_;
  std::vector<std::size_t> depths_;  // by number: how many predictions a field rests on in a row
  AddedFields added_;                // `kept` from the beginning
};

/// The same for one mesh.
[[nodiscard]] Result<AddedFields> addFields(const LogFile& log, const TetMesh& mesh,
                                            const AddFieldsOptions& options = {});

}  // namespace qtet
