#include "simplify/read/options/select_fields.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "proto/field_key.h"
#include "proto/field_list.h"
#include "proto/limits.h"
#include "proto/utf8.h"

namespace qtet {
namespace {

/// Advice on integers that no double holds.
const std::string kLabelsInstead =
    "number its different values 0, 1, 2 ... and store these labels as int32";

std::string namesOf(const std::vector<MeshField>& fields, const std::vector<std::string>& others) {
  std::vector<std::string> out;
  for (const MeshField& field : fields) out.push_back(field.name);
  out.insert(out.end(), others.begin(), others.end());
  return fieldList(out);
}

/// Names of the fields in which VTK's filters say where points and cells come from.
constexpr std::string_view kVtkOriginals[] = {"vtkOriginalPointIds", "vtkOriginalCellIds"};

bool numbersThings(const MeshField& field) {
  if (isFloatType(field.type) || field.components != 1 || !field.labelNames.empty()) return false;
  const std::string_view name = field.name.withoutTime();
  if (std::ranges::find(kVtkOriginals, name) != std::end(kVtkOriginals)) return true;
  if (field.values.size() < kFewestNumbers) return false;
  std::vector<double> sorted = field.values;
  std::ranges::sort(sorted);
  return std::ranges::adjacent_find(sorted) == sorted.end();
}

bool isWithin(const Threshold& threshold, const MeshField& field, std::size_t tuple) {
  const double value = field.values[tuple * field.components];
  return value >= threshold.low && value <= threshold.high;
}

bool allWithin(const Threshold& threshold, const MeshField& field, const CellMesh& mesh,
               std::size_t cell) {
  if (isCellField(field)) return isWithin(threshold, field, cell);
  bool all = true;
  forEachId(mesh.types[cell], mesh.cell(cell),
            [&](VertexId v) { all = all && isWithin(threshold, field, v); });
  return all;
}

}  // namespace

bool isMeant(const FieldNames& names, const std::string& association, const FieldName& name) {
  return !names || std::ranges::any_of(*names, [&](const FieldName& asked) {
    return isCalled(association, name, asked) || isCalled(association, name.withoutTime(), asked) ||
           isCalled(association, name, asked.withoutTime());
  });
}

Status selectFields(const FieldNames& names, const std::filesystem::path& path,
                    const std::vector<std::string>& otherFields, std::vector<MeshField>& fields) {
  if (names) {
    std::vector<std::size_t> order;
    for (const std::string& asked : *names) {
      const std::vector<std::uint32_t> meant = fieldsOfKey(fields, asked);
      for (const std::uint32_t f : meant) {
        if (std::ranges::find(order, f) == order.end()) order.push_back(f);
      }
      if (meant.empty())
        return fail(ErrorCode::kNotFound, path.string() + " has no field '" + asked +
                                              "'; it has: " + namesOf(fields, otherFields));
    }
    std::vector<MeshField> chosen;
    for (const std::size_t f : order) chosen.push_back(std::move(fields[f]));
    fields = std::move(chosen);
  }
  if (fields.size() <= kMaxFields) return {};
  return fail(ErrorCode::kLimitExceeded, path.string() + ": " + std::to_string(fields.size()) +
                                             " fields; choose at most " +
                                             std::to_string(kMaxFields) + " with `fields`");
}

Status applyThreshold(const Threshold& threshold, const std::filesystem::path& path,
                      CellMesh& mesh) {
  const auto place = fieldOfKey(mesh.fields, threshold.field);
  if (!place) {
    return fail(ErrorCode::kNotFound,
                path.string() + " has no field '" + threshold.field +
                    "' for `threshold`; it has: " + namesOf(mesh.fields, mesh.otherFields));
  }
  const MeshField& field = mesh.fields[*place];
  CellMesh out;
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < mesh.cells(); ++i) {
    if (!allWithin(threshold, field, mesh, i)) continue;
    out.addCell(mesh.types[i], mesh.cell(i));
    out.cellIds.push_back(mesh.cellId(i));
    kept.push_back(i);
  }
  if (kept.empty())
    return fail(ErrorCode::kBadInput, path.string() + ": no cell lies within `threshold` " +
                                          threshold.field + "; widen it");
  for (MeshField& other : mesh.fields) {
    if (!isCellField(other)) continue;
    for (std::size_t i = 0; i < kept.size(); ++i)
      std::copy_n(other.values.data() + kept[i] * other.components, other.components,
                  other.values.data() + i * other.components);
    other.values.resize(kept.size() * other.components);
  }
  mesh.types = std::move(out.types);
  mesh.begins = std::move(out.begins);
  mesh.vertices = std::move(out.vertices);
  mesh.cellIds = std::move(out.cellIds);
  return {};
}

Status leaveOutWideIntegers(const FieldNames& names, const std::filesystem::path& path,
                            std::vector<MeshField>& fields, std::vector<std::string>& notes) {
  constexpr double kFirstInexactInteger = 0x1p53;
  const auto isWide = [](double value) { return std::abs(value) >= kFirstInexactInteger; };
  for (std::size_t f = 0; f < fields.size();) {
    const MeshField& field = fields[f];
    const bool mayBeWide = field.type == "int64" || field.type == "uint64";
    const auto wide = mayBeWide && isMeant(names, field.association, field.name)
                          ? std::ranges::find_if(field.values, isWide)
                          : field.values.end();
    if (wide == field.values.end()) {
      ++f;
      continue;
    }
    const auto place = static_cast<std::size_t>(wide - field.values.begin()) / field.components;
    const std::string what = field.association + " field " + field.name +
                             " holds an integer of 2^53 or more at " + field.association + " " +
                             std::to_string(place);
    if (names)
      return fail(
          ErrorCode::kBadInput,
          path.string() + ": " + what + "; leave the field out of `fields`, or " + kLabelsInstead);
    notes.push_back(what + " and was left out, since no double tells it from its neighbours; " +
                    kLabelsInstead + " to keep it");
    fields.erase(fields.begin() + static_cast<std::ptrdiff_t>(f));
  }
  return {};
}

void leaveOutNumbers(const FieldNames& names, CellMesh& mesh, std::vector<std::string>& notes) {
  if (names) return;
  std::vector<std::string> left;
  std::erase_if(mesh.fields, [&](const MeshField& field) {
    if (!numbersThings(field)) return false;
    left.push_back(field.association + ":" + field.name);
    mesh.otherFields.push_back(field.name);
    return true;
  });
  if (!left.empty())
    notes.push_back("fields that only number points or cells are left out: " + fieldList(left) +
                    "; `fields` reads them, too");
}

const char* integerTypeOf(std::span<const double> values) {
  using Narrow = std::numeric_limits<std::int32_t>;
  return std::ranges::all_of(values,
                             [](double v) { return v >= Narrow::min() && v <= Narrow::max(); })
             ? "int32"
             : "int64";
}

bool isStorableName(const std::string& name) {
  return !name.empty() && name.size() <= kMaxNameBytes && isUtf8(name);
}

void nameFields(std::vector<MeshField>& fields, std::vector<std::string>& notes) {
  using Called = std::pair<std::string, std::string>;  // association and name
  std::set<Called> taken;
  std::map<Called, int> next;  // of a stem the first number that may be free
  for (std::size_t f = 0; f < fields.size(); ++f) {
    MeshField& field = fields[f];
    if (std::erase_if(field.labelNames,
                      [](const auto& entry) { return !isStorableName(entry.second); }) > 0)
      notes.push_back("names of values of " + field.name +
                      " that are empty, no UTF-8 or longer than " + std::to_string(kMaxNameBytes) +
                      " bytes are left out");
    const bool storable = isStorableName(field.name);
    if (storable && taken.emplace(field.association, field.name).second) continue;
    constexpr std::size_t kLongestEnding = 8;
    const std::string before = field.name;
    const std::string stem = storable && before.size() + kLongestEnding <= kMaxNameBytes
                                 ? before
                                 : "unnamed-" + std::to_string(f);
    field.name = stem;
    int& again = next.try_emplace({field.association, stem}, 2).first->second;
    while (!taken.emplace(field.association, field.name).second)
      field.name = stem + "-" + std::to_string(again++);
    notes.push_back(field.association + " field number " + std::to_string(f) + " is called " +
                    field.name + ": " +
                    (storable ? "an earlier one has its name, " + before
                              : "it has no name of at most " + std::to_string(kMaxNameBytes) +
                                    " bytes of UTF-8"));
  }
}

}  // namespace qtet
