#include "simplify/produce/added_steps.h"

#include <algorithm>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <utility>

#include "proto/field_name.h"
#include "proto/number_text.h"
#include "proto/series.h"
#include "simplify/clean/clean_mesh.h"
#include "simplify/mesh/moved_place.h"
#include "simplify/produce/known_instants.h"
#include "simplify/read/listed_files.h"
#include "simplify/read/read_mesh.h"
#include "simplify/read/read_times.h"
#include "simplify/read/steps/cell_labels.h"
#include "simplify/read/steps/step_reports.h"
#include "simplify/series/series.h"

namespace qtet {
namespace {

/// Gives fields without a time that of their file. Errors: bad-input (neither knows a time, or both
/// do).
Status nameInstants(TetMesh& mesh, const std::string& file, const std::optional<double>& time) {
  for (MeshField& field : mesh.fields) {
    const bool isNamed = field.name.isInstant();
    if (isNamed && time)
      return fail(ErrorCode::kBadInput,
                  file + " has times of its own (" + field.name + "); leave --times out");
    if (!isNamed && !time)
      return fail(ErrorCode::kBadInput, file + " knows no time; give it with --times");
    if (!isNamed) field.name = field.name.at(shortestText(*time));
  }
  return {};
}

/// Adds meshes in windows, so that the values of no more than one window are in memory at once. The
/// log is decoded before the first one.
class Windows {
 public:
  Windows(const LogFile& log, const AddFieldsOptions& options) : log_(log), options_(options) {}

  /// Decodes the log, if that is not done.
  Status prepare() {
    if (adder_) return {};
    Result<FieldAdder> adder = FieldAdder::make(log_, options_);
    if (!adder) return std::unexpected(adder.error());
    adder_.emplace(std::move(*adder));
    return {};
  }
  /// Steps that fill the window. REQUIRES: prepared.
  [[nodiscard]] std::size_t room() const { return adder_->roomInWindow() - steps_.size(); }
  /// REQUIRES: prepared.
  Status take(TetMesh&& mesh) {
    const bool isSame = mesh.points == pending_.points && mesh.tetrahedra == pending_.tetrahedra;
    if (!isSame)
      if (Status s = flush(); !s) return s;
    for (const MeshField& field : mesh.fields) steps_.insert(field.name.instant()->time);
    if (pending_.fields.empty()) {
      pending_ = std::move(mesh);
    } else {
      std::ranges::move(mesh.fields, std::back_inserter(pending_.fields));
    }
    return steps_.size() < adder_->roomInWindow() ? Status{} : flush();
  }
  Status flush() {
    if (pending_.fields.empty()) return {};
    const Status added = adder_->add(pending_);
    pending_.fields.clear();
    steps_.clear();
    return added;
  }
  AddedFields finish() { return adder_ ? adder_->take() : AddedFields{}; }

 private:
  const LogFile& log_;
  const AddFieldsOptions& options_;
  std::optional<FieldAdder> adder_;
  TetMesh pending_;
  std::set<double> steps_;  // of `pending_`
};

std::string listOf(const std::set<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

class Adding {
 public:
  Adding(const OpenedLog& log, const StepsRequest& request, Progress& progress)
      : units_(log.manifest.units),
        request_(request),
        progress_(progress),
        reading_(request.reading),
        known_(log.manifest),
        windows_(log.file, request.adding) {
    reading_.namesTime = true;
    reading_.moves = std::ranges::any_of(log.manifest.fields, [](const ManifestField& field) {
      const auto name = field.name.instant();
      return name && name->series == kDisplacement;
    });
  }

  Status takeAll() {
    for (std::size_t i = 0; i < request_.files.size() && !out_.stopped; ++i) {
      const auto time = request_.times.empty() ? std::nullopt : std::optional(request_.times[i]);
      if (Status s = take(request_.files[i], time); !s) return s;
    }
    return windows_.flush();
  }
  AddedSteps finish() {
    AddedFields added = windows_.finish();
    if (!others_.empty())
      notes_.push_back("left out, since the log has no such series: " + listOf(others_) +
                       "; --fields adds them");
    added.notes.insert(added.notes.begin(), notes_.begin(), notes_.end());
    if (out_.skipped > 0)
      added.notes.push_back(
          std::to_string(out_.skipped) + (out_.skipped == 1 ? " step was" : " steps were") +
          " left out, since the log has " + (out_.skipped == 1 ? "its time" : "their times"));
    if (std::string between = known_.warning(); !between.empty())
      added.warnings.push_back(std::move(between));
    out_.added = std::move(added);
    return std::move(out_);
  }

 private:
  Status take(const std::string& file, const std::optional<double>& time) {
    progress_.stage("adding " + file);
    if (time && mayLeave() && known_.knows(*time)) {
      ++out_.skipped;
      return {};
    }
    if (!time) {
      const Result<ReadOptions> reading = withListedFiles(file, reading_);
      if (!reading) return std::unexpected(reading.error());
      const Result<ChosenTimes> chosen = chosenTimesOf(file, *reading);
      if (!chosen) return std::unexpected(chosen.error());
      if (!chosen->times.empty()) return takeTimes(file, *reading, chosen->times);
    }
    Result<ReadMesh> read = readMesh(file, reading_);
    if (!read) return unreadable(read.error());
    return take(std::move(*read), file, time);
  }

  /// Ends the reading, where the steps before are to be added.
  Status unreadable(const Error& error) {
    if (!request_.keepsEarlier || out_.steps == 0) return std::unexpected(error);
    out_.stopped = error;
    return {};
  }

  /// Steps need not be read to be left out: no field is asked for that the log may lack.
  [[nodiscard]] bool mayLeave() const { return !request_.reading.fields.has_value(); }

  Status takeTimes(const std::string& file, const ReadOptions& reading,
                   const std::vector<double>& all) {
    std::vector<double> times = all;
    if (mayLeave()) std::erase_if(times, [&](double time) { return known_.knows(time); });
    out_.skipped += all.size() - times.size();
    if (times.empty()) return {};
    if (Status s = windows_.prepare(); !s) return s;
    bool isOneByOne = false;  // one of the steps cannot be read
    for (std::size_t at = 0; at < times.size();) {
      const std::size_t count = isOneByOne ? 1 : std::min(windows_.room(), times.size() - at);
      Result<ReadMesh> read = readTimes(file, reading, std::span(times).subspan(at, count),
                                        reading.moves ? std::optional(all.front()) : std::nullopt);
      if (!read && request_.keepsEarlier && count > 1) {
        isOneByOne = true;
        continue;
      }
      if (!read) return unreadable(read.error());
      if (Status s = take(std::move(*read), file, std::nullopt); !s) return s;
      at += count;
    }
    return {};
  }

  Status take(ReadMesh&& read, const std::string& file, const std::optional<double>& time) {
    eraseLabelFields(read.report, read.mesh.fields);  // they have no time
    if (Status s = nameInstants(read.mesh, file, time); !s) return s;
    if (Status s = checkValueBounds(read.mesh.fields, request_.adding.errors, units_); !s) return s;
    if (Status s = keepInstants(read.mesh, file); !s) return s;
    if (read.mesh.fields.empty()) return {};
    if (const auto cleaned = cleanMesh(read.mesh); !cleaned)
      return std::unexpected(cleaned.error());
    addNew(read.report.notes, notes_);
    if (Status s = windows_.prepare(); !s) return s;
    return windows_.take(std::move(read.mesh));
  }

  /// Leaves the fields of which the log has a series, or all that are asked for, without instants
  /// that it has.
  Status keepInstants(TetMesh& mesh, const std::string& file) {
    std::set<std::string> others;
    std::set<double> skipped, come;
    std::erase_if(mesh.fields, [&](const MeshField& field) {
      if (!known_.knowsSeriesOf(field) && mayLeave()) {
        others.emplace(field.name.instant()->series);
        return true;
      }
      const bool isThere = known_.has(field);
      (isThere ? skipped : come).insert(field.name.instant()->time);
      return isThere;
    });
    for (const double time : come) skipped.erase(time);
    out_.steps += come.size(), out_.skipped += skipped.size();
    if (come.empty() && skipped.empty())
      return fail(ErrorCode::kNotFound,
                  file + " holds no instant of a series of the log" +
                      (others.empty() ? "" : " (it has " + listOf(others) + ")") +
                      "; name others with --fields");
    others_.merge(others);
    std::ranges::sort(mesh.fields, {}, [](const MeshField& field) {
      return std::tuple(field.name.instant()->time, field.association, field.name);
    });
    for (MeshField& field : mesh.fields)
      if (Status s = known_.add(field, file); !s) return s;
    return {};
  }

  const Units& units_;
  const StepsRequest& request_;
  Progress& progress_;
  ReadOptions reading_;
  KnownInstants known_;
  Windows windows_;
  std::vector<std::string> notes_;
  std::set<std::string> others_;  // series that the log lacks
  AddedSteps out_;
};

}  // namespace

Result<AddedSteps> addedSteps(const OpenedLog& log, const StepsRequest& request,
                              Progress& progress) {
  Adding adding(log, request, progress);
  if (Status s = adding.takeAll(); !s) return std::unexpected(s.error());
  return adding.finish();
}

}  // namespace qtet
