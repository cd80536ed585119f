#include "simplify/clean/place_fields.h"

#include <cassert>
#include <optional>

#include "proto/limits.h"
#include "proto/number_text.h"
#include "simplify/clean/field_scales.h"
#include "simplify/mesh/stopping.h"

namespace qtet {

Result<PlacedFields> placeFields(std::span<const MeshField> fields, const QuantiseOptions& options,
                                 const std::stop_token& stop) {
  const std::vector<std::optional<ValueBound>> bounds = valueBoundsOf(fields, options.errors);
  const FieldScales all = scalesOf(fields);
  PlacedFields out;
  out.warnings = all.outlying.warnings();
  for (std::size_t f = 0; f < fields.size(); ++f) {
    throwIfStopped(stop);
    Result<QuantisedField> quantised =
        quantiseBy(all.scales[f], fields[f], options.fieldBits, bounds[f]);
    if (!quantised) return std::unexpected(quantised.error());
    assert(quantised->values.size() == fields[f].values.size());
    assert(quantised->missing.empty() == (quantised->nonFinite == 0));
    const bool isTooFine =
        isFloatType(fields[f].type) && !bounds[f] && quantised->info.step == kFinestFieldStep;
    out.tooFine.push_back(isTooFine ? all.scales[f].extents.largest() : 0);
    out.fields.push_back(std::move(*quantised));
  }
  return out;
}

void noteFields(const PlacedFields& placed, std::span<const FieldInfo> infos,
                QuantiseReport& report) {
  assert(placed.fields.size() == infos.size() && report.nonFiniteOf.size() == infos.size());
  report.warnings = placed.warnings;
  for (std::size_t f = 0; f < infos.size(); ++f) {
    const FieldInfo& info = infos[f];
    const std::string name = (isCellField(info) ? "cell field " : "field ") + info.name;
    report.nonFiniteValues += report.nonFiniteOf[f];
    if (report.nonFiniteOf[f] > 0)
      report.notes.push_back(name + ": " + std::to_string(report.nonFiniteOf[f]) +
                             " values are NaN or infinite and come back as NaN");
    if (placed.tooFine[f] > 0)
      report.notes.push_back(
          name + ": its values span " + roundedText(placed.tooFine[f]) +
          ", and the finest step of a log is " + roundedText(kFinestFieldStep) +
          "; multiply them, such as by 1e300, or keep its own values by `lossless`");
    if (!placed.fields[f].exact && !isFloatType(info.type))
      report.notes.push_back(name + ": its integers span more than " +
                             std::to_string(kMaxFieldBits) + " bits and are rounded to " +
                             std::to_string(info.bits) + " bits");
  }
}

}  // namespace qtet
