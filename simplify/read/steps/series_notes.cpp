#include "simplify/read/steps/series_notes.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>

#include "proto/field_name.h"
#include "proto/number_text.h"
#include "simplify/read/options/bad_file.h"
#include "simplify/read/options/time_text.h"
#include "simplify/read/steps/common_type.h"
#include "simplify/read/steps/moving_points.h"
#include "simplify/read/steps/step_reports.h"

namespace qtet {
namespace {

/// Fields that miss steps, or change their types, and are named.
constexpr std::size_t kNamedFields = 6;

std::string shownTimes(const std::set<double>& times) {
  return qtet::shownTimes(std::vector<double>(times.begin(), times.end()));
}

bool isTooWide(const MeshField& field) {
  constexpr double kFirstInexact = 0x1p53;
  return (field.type == "int64" || field.type == "uint64") &&
         std::ranges::any_of(field.values, [](double v) { return std::abs(v) >= kFirstInexact; });
}

std::set<double> allTimes(const InstantsReport& instants) {
  std::set<double> out;
  for (const auto& [type, times] : instants.times) out.insert(times.begin(), times.end());
  return out;
}

std::string nameOf(const std::pair<std::string, std::string>& key) {
  return key.first + " field " + key.second;
}

std::string componentsText(const InstantsReport& instants) {
  return std::to_string(instants.components) +
         (instants.components == 1 ? " component" : " components") + " at time " +
         shownTimes(allTimes(instants));
}

Status addOne(const std::pair<std::string, std::string>& key, const InstantsReport& more,
              const std::filesystem::path& path, SeriesReport& series) {
  const auto [place, isNew] = series.fields.try_emplace(key, more);
  if (isNew) return {};
  InstantsReport& known = place->second;
  if (known.components != more.components)
    return badFile(path, nameOf(key) + " has " + componentsText(known) + ", and " +
                             componentsText(more) +
                             "; write it alike at all steps, or name other fields with `fields`");
  known.type = commonType(known.type, more.type);
  for (const auto& [type, times] : more.times) known.times[type].insert(times.begin(), times.end());
  return {};
}

/// Notes on the first few fields; the others are counted.
template <class NoteOf>
void addFieldNotes(const SeriesReport& series, const std::string& others, const NoteOf& noteOf,
                   std::vector<std::string>& out) {
  std::size_t count = 0;
  for (const auto& [key, instants] : series.fields) {
    const std::string note = noteOf(instants);
    if (!note.empty() && ++count <= kNamedFields) out.push_back(nameOf(key) + note);
  }
  if (count > kNamedFields)
    out.push_back(std::to_string(count - kNamedFields) + " fields more " + others);
}

std::string motionNote(const MotionReport& motion, std::size_t steps) {
  const std::string moves = "the points move over its " + std::to_string(steps) + " steps; ";
  const std::string rest = shortestText(motion.rest);
  if (!motion.isRead)
    return moves + "the mesh of time " + rest + " stands for all of them, and `fields` " +
           motion.field + " would say how far they move";
  return moves + "the mesh is that of time " + rest + ", and the point field " + motion.field +
         " has how far they are from there, at most " + roundedText(motion.largest) +
         (motion.field == kDisplacement
              ? ""
              : "; the file has a field " + std::string(kDisplacement) + " of its own");
}

}  // namespace

Status addInstants(const std::vector<MeshField>& fields, const std::filesystem::path& path,
                   SeriesReport& series) {
  // of all steps together, so that an error names all times
  std::map<std::pair<std::string, std::string>, std::map<std::uint32_t, InstantsReport>> found;
  for (const MeshField& field : fields) {
    const auto name = field.name.instant();
    if (!name || isTooWide(field)) continue;
    InstantsReport& instants =
        found[{field.association, std::string(name->series)}][field.components];
    instants.components = field.components;
    instants.type = instants.type.empty() ? field.type : commonType(instants.type, field.type);
    instants.times[field.type].insert(name->time);
  }
  for (const auto& [key, kinds] : found)
    for (const auto& [components, instants] : kinds)
      if (Status added = addOne(key, instants, path, series); !added) return added;
  return {};
}

void setTypes(const SeriesReport& series, std::vector<MeshField>& fields) {
  for (MeshField& field : fields) {
    const auto name = field.name.instant();
    if (!name || isTooWide(field)) continue;
    const auto known = series.fields.find({field.association, std::string(name->series)});
    if (known != series.fields.end()) field.type = known->second.type;
  }
}

std::vector<std::string> seriesNotes(const SeriesReport& series) {
  std::vector<std::string> out;
  if (!series.reordered.empty())
    out.push_back("its points or cells stand in another order at time " +
                  shownTimes(series.reordered) + ", and were put into that of time " +
                  shortestText(*series.times.begin()));
  addFieldNotes(
      series, "miss some steps",
      [&](const InstantsReport& instants) {
        const std::set<double> there = allTimes(instants);
        std::set<double> missing;
        std::ranges::set_difference(series.times, there, std::inserter(missing, missing.end()));
        return missing.empty() ? "" : " is missing at time " + shownTimes(missing);
      },
      out);
  addFieldNotes(
      series, "change their types",
      [](const InstantsReport& instants) {
        return instants.times.size() < 2
                   ? ""
                   : " changes its type over the steps; " + instants.type + " holds all its values";
      },
      out);
  if (series.motion) out.push_back(motionNote(*series.motion, series.times.size()));
  return out;
}

Status addWindow(ReadReport&& window, const std::filesystem::path& path, ReadReport& report) {
  const auto eraseNotes = [](ReadReport& from) {
    for (const std::string& note : seriesNotes(from.series)) std::erase(from.notes, note);
  };
  eraseNotes(window), eraseNotes(report);
  SeriesReport &series = report.series, &more = window.series;
  series.times.merge(more.times);
  series.reordered.merge(more.reordered);
  for (const auto& [key, instants] : more.fields)
    if (Status added = addOne(key, instants, path, series); !added) return added;
  if (!series.motion) {
    series.motion = std::move(more.motion);
  } else if (more.motion) {
    series.motion->moved.merge(more.motion->moved);
    series.motion->largest = std::max(series.motion->largest, more.motion->largest);
  }
  if (report.motion.empty()) report.motion = std::move(window.motion);
  addNew(window.notes, report.notes);
  std::ranges::move(seriesNotes(series), std::back_inserter(report.notes));
  return {};
}

Status checkWindow(const SeriesReport& window, const std::filesystem::path& path,
                   const SeriesReport& known) {
  if (window.motion && window.motion->isRead && !known.motion)
    return badFile(
        path, "its points move at time " + shownTimes(window.motion->moved) +
                  ", but rest at the times that choose the fusions, " + shownTimes(known.times) +
                  "; choose fewer steps with `time`, so that all are simplified at once");
  for (const auto& [key, instants] : window.fields) {
    const auto at = known.fields.find(key);
    if (at == known.fields.end()) continue;
    const std::string& type = at->second.type;
    for (const auto& [own, times] : instants.times)
      if (commonType(type, own) != type)
        return badFile(path, nameOf(key) + " is " + own + " at time " + shownTimes(times) +
                                 ", which the " + type +
                                 " of earlier steps does not hold; write it in one type at all "
                                 "steps, or choose fewer steps with `time`");
  }
  return {};
}

}  // namespace qtet
