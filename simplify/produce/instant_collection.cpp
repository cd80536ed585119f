#include "simplify/produce/instant_collection.h"

#include <algorithm>
#include <system_error>

#include "codec/files/atomic_file.h"
#include "proto/text_bytes.h"
#include "simplify/produce/extract_times.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

/// The file of this number, relative to the collection.
fs::path fileOfCollection(const fs::path& collection, std::size_t number) {
  const std::string name = collection.stem().string(), digits = std::to_string(number);
  return fs::path(name) /
         (name + "_" + std::string(4 - std::min<std::size_t>(4, digits.size()), '0') + digits +
          ".vtu");
}

}  // namespace

InstantCollection::~InstantCollection() {
  std::error_code ignored;
  if (ownsFolder_) fs::remove_all(folder(), ignored);
}

fs::path InstantCollection::folder() const { return file_.parent_path() / file_.stem(); }

Status InstantCollection::add(std::optional<double> time, ByteView bytes) {
  std::error_code code;
  if (written_.empty() && !fs::create_directory(folder(), code))
    return fail(ErrorCode::kIo, "the folder " + folder().string() + " for the instants " +
                                    (code ? "cannot be made: " + code.message()
                                          : "exists; remove it or choose another output"));
  ownsFolder_ = true;
  const fs::path name = fileOfCollection(file_, written_.size());
  if (Status s = writeFileAtomically(file_.parent_path() / name, bytes); !s) return s;
  written_.emplace_back(time, name.generic_string());
  bytes_ += bytes.size();
  return {};
}

Status InstantCollection::finish() { return finish(collectionText(written_)); }

Status InstantCollection::finish(std::string_view text) {
  if (Status s = writeFileAtomically(file_, viewOf(text)); !s) return s;
  bytes_ += text.size();
  ownsFolder_ = false;
  return {};
}

std::vector<std::string> InstantCollection::names() const {
  std::vector<std::string> out;
  for (const auto& [time, file] : written_) out.push_back(file);
  return out;
}

OrderedJson InstantCollection::filesJson() const {
  OrderedJson out = OrderedJson::array();
  for (const auto& [time, file] : written_)
    out.push_back({{"time", time.value_or(0)}, {"file", file}});
  return out;
}

std::string InstantCollection::sentence() const {
  return counted(written_.size(), "instant", "instants") + " in " + folder().string();
}

}  // namespace qtet
