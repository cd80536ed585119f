#include "simplify/read/ensight/read_ensight.h"

#include <algorithm>
#include <iterator>

#include "simplify/read/ensight/ensight_values.h"
#include "simplify/read/options/bad_file.h"
#include "simplify/read/options/grid_parts.h"
#include "simplify/read/process/inflate_file.h"
#include "simplify/read/steps/join_blocks.h"
#include "simplify/read/steps/step_reports.h"

namespace qtet {
namespace {

class CaseReader {
 public:
  CaseReader(const EnSightCase& of, const ReadOptions& options) : case_(of), options_(options) {}

  /// The mesh of the time. `time`: nullptr if the case knows none.
  Result<CellMesh> read(const double* time, ReadReport& report) {
    const auto stepOf = [&](const EnSightItem& item) {
      return time ? case_.stepAt(item, *time) : 0;
    };
    const std::uint64_t step = stepOf(case_.model);
    Result<EnSightGeometry> geometry = geometryOf(step, bounds_, report);
    if (!geometry) return std::unexpected(geometry.error());
    CellMesh unread;
    FieldChoice choice(options_.fields, report);
    int number = 0;
    for (const EnSightVariable& variable : case_.variables) {
      const auto name = choice.nameOf({variable.name, number++, variable.components},
                                      variable.isOfElements ? "cell" : "point", unread);
      if (!name) continue;
      if (Status done =
              addField(variable, *name, stepOf(variable.item), *geometry, bounds_, report);
          !done)
        return std::unexpected(done.error());
    }
    std::vector<CellMesh> blocks;
    for (EnSightBlock& block : geometry->blocks) blocks.push_back(std::move(block.mesh));
    CellMesh out = joinBlocks(std::move(blocks), options_, report);
    out.otherFields = std::move(unread.otherFields);
    return out;
  }

 private:
  Result<EnSightGeometry> geometryOf(std::uint64_t step, EnSightBounds& bounds,
                                     ReadReport& report) {
    Result<EnSightGeometry> out = oneGeometry(step, bounds, report);
    if (!out || !case_.changesCoordinatesOnly || step == case_.cellStep) return out;
    ReadReport ofCells;
    Result<EnSightGeometry> cells = oneGeometry(case_.cellStep, bounds, ofCells);
    if (!cells) return cells;
    if (Status done = movePoints(*cells, *out, case_.path); !done)
      return std::unexpected(done.error());
    report.ignoredCells = ofCells.ignoredCells;
    return cells;
  }

  Result<EnSightGeometry> oneGeometry(std::uint64_t step, EnSightBounds& bounds,
                                      ReadReport& report) {
    const Result<EnSightPlace> place = case_.placeOf(case_.model, step);
    if (!place) return std::unexpected(place.error());
    const Result<EnSightEncoding> encoding = encodingOf(place->file, case_.isGold);
    if (!encoding) return named("it names its model: ", encoding.error());
    const Result<std::string> bytes = files_.read(*place, *encoding);
    if (!bytes) return named("it names its model: ", bytes.error());
    return readEnSightGeometry(*bytes, place->file, *encoding, bounds, report);
  }

  [[nodiscard]] std::unexpected<Error> named(const std::string& what, const Error& error) const {
    return fail(error.code, case_.path.string() + ": " + what + error.message);
  }

  Status addField(const EnSightVariable& variable, const std::string& name, std::uint64_t step,
                  EnSightGeometry& geometry, EnSightBounds& bounds, ReadReport& report) {
    const auto bad = [&](const Error& error) {
      return badFile(case_.path, "its variable " + variable.name + ": " + error.message +
                                     "; export the case again, or take the variable out of it");
    };
    const Result<EnSightPlace> place = case_.placeOf(variable.item, step);
    if (!place) return std::unexpected(place.error());
    const Result<std::string> bytes = files_.read(*place, geometry.encoding);
    if (!bytes) return bad(bytes.error());
    auto values = readEnSightValues(*bytes, place->file, variable, geometry, bounds);
    if (!values) return bad(values.error());
    bool isAnywhere = false;
    for (std::size_t i = 0; i < values->size(); ++i) {
      if ((*values)[i].empty()) continue;
      isAnywhere = true;
      EnSightBlock& block = geometry.blocks[i];
      MeshField field{name, variable.components, "float32", std::move((*values)[i]),
                      variable.isOfElements ? "cell" : "point"};
      if (variable.isOfElements) keepRows(field, block.rows);
      block.mesh.fields.push_back(std::move(field));
    }
    if (!isAnywhere)
      report.notes.push_back("its variable " + variable.name +
                             " was left out: it has values of parts without volumes alone");
    return {};
  }

  const EnSightCase& case_;
  const ReadOptions& options_;
  EnSightFiles files_{options_.patience};
  EnSightBounds bounds_{options_.patience, maxInflatedBytes()};  // of all steps together
};

}  // namespace

Result<std::vector<TimedCells>> readEnSight(const std::filesystem::path& path,
                                            const ReadOptions& options, ReadReport& report) {
  const Result<EnSightCase> found = readEnSightCase(path);
  if (!found) return std::unexpected(found.error());
  std::ranges::copy(found->notes, std::back_inserter(report.notes));
  CaseReader reader(*found, options);
  const std::vector<double> times = found->times();
  return readChosen(times, path, options, report, [&](std::size_t step, ReadReport& ofStep) {
    return reader.read(times.empty() ? nullptr : &times[step], ofStep);
  });
}

}  // namespace qtet
