// `qtet page`: one HTML file with the viewer and a log in it.
#include <algorithm>
#include <boost/program_options.hpp>
#include <charconv>
#include <numeric>
#include <span>

#include "codec/files/atomic_file.h"
#include "codec/refine/log_edit.h"
#include "proto/level_error_json.h"
#include "proto/series.h"
#include "simplify/commands/commands.h"
#include "simplify/commands/provided_log.h"
#include "simplify/commands/tool_main.h"
#include "simplify/log/opened_log.h"
#include "simplify/publish/publish_site.h"
#include "simplify/publish/single_page.h"
#include "simplify/read/process/guarded_folder.h"
#include "simplify/series/fewer_instants.h"
#include "simplify/words/columns.h"
#include "simplify/words/json_report.h"
#include "simplify/words/measure_words.h"
#include "simplify/words/output.h"
#include "simplify/words/parsed_words.h"
#include "simplify/words/read_words.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

Result<SinglePage> pageOf(const fs::path& folder, const fs::path& log, const fs::path& viewer,
                          const SinglePageOptions& options) {
  const fs::path site = folder / "site";
  const Result<PublishedSite> made = publishSite(site, viewer, {log}, Codings::kNone);
  if (!made) return std::unexpected(made.error());
  return singlePage(site, options);
}

/// 5000000, 500k or 5M. Throws UsageError.
std::optional<std::uint64_t> maxBytesOf(const ParsedWords& parsed) {
  if (!parsed.has("max-bytes")) return std::nullopt;
  const auto word = parsed.get<std::string>("max-bytes");
  std::uint64_t number = 0;
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), number);
  const std::string_view unit(end, word.data() + word.size());
  const std::uint64_t factor = unit.empty() ? 1 : unit == "k" ? 1000 : unit == "M" ? 1000000 : 0;
  if (code != std::errc() || factor == 0 || number == 0 || number > kMaxPageBytes)
    throw UsageError("--max-bytes takes a number of bytes, as 5000000, 500k or 5M, and not '" +
                     word + "'");
  return number * factor;
}

/// A page, the log that it was made of, and that log's instants where some were left out.
struct MadePage {
  Result<SinglePage> page;
  fs::path log;
  std::string instants{};  ///< "; it holds 13 of 50 instants"

  [[nodiscard]] bool isCut() const {
    return page ? page->chunks > 0 : page.error().code == ErrorCode::kLimitExceeded;
  }
};

/// Instants of the longest series, of these fields alone, ascending numbers.
std::size_t instantsOf(const Manifest& manifest, const std::vector<std::uint32_t>& fields) {
  const auto isKept = [&](std::size_t f) { return std::ranges::binary_search(fields, f); };
  std::ptrdiff_t out = 0;
  for (const Series& series : manifest.series)
    out = std::max(out, std::ranges::count_if(series.fields, isKept));
  return static_cast<std::size_t>(out);
}

/// Where the log does not fit, instants of its series go before levels do.
Result<MadePage> fittingPage(const fs::path& folder, const fs::path& log, const fs::path& viewer,
                             const SinglePageOptions& options) {
  MadePage out{pageOf(folder, log, viewer, options), log};
  if (!out.isCut()) return out;
  const Result<OpenedLog> whole = openLog(log);
  if (!whole) return std::unexpected(whole.error());
  const Manifest& manifest = whole->manifest;
  std::vector<std::uint32_t> all(manifest.fields.size());
  std::iota(all.begin(), all.end(), 0u);
  for (const auto& kept : fewerInstants(manifest, whole->file.fields())) {
    const fs::path part = folder / std::to_string(kept.size());
    const Result<EditedLog> thinned = withFields(whole->file, kept, {});
    if (!thinned) return std::unexpected(thinned.error());
    std::error_code code;
    fs::create_directory(part, code);
    if (Status s = writeFileAtomically(
            part / log.filename(), [&](const ByteSink& sink) { return thinned->writeTo(sink); });
        !s)
      return std::unexpected(s.error());
    out = {pageOf(part, part / log.filename(), viewer, options), part / log.filename(),
           "; it holds " + grouped(instantsOf(manifest, kept)) + " of " +
               grouped(instantsOf(manifest, all)) + " instants"};
    if (!out.isCut()) break;
  }
  return out;
}

/// "it holds 20,145 of 212,544 tetrahedra: boundary within 0.3 % of the diagonal, T rms 0.2 %".
Result<std::string> heldPart(const fs::path& path, std::uint32_t chunks) {
  const Result<OpenedLog> log = openLog(path);
  if (!log) return std::unexpected(log.error());
  const std::vector<ManifestLevel>& levels = log->manifest.levels;
  const ManifestLevel* held = &levels.front();
  const LevelError* error = nullptr;
  for (const ManifestLevel& level : levels) {
    if (level.chunk >= chunks) break;
    held = &level;
    if (level.error) error = &*level.error;
  }
  std::string out = "; it holds " + grouped(held->tetrahedra) + " of " +
                    grouped(levels.back().tetrahedra) + " tetrahedra";
  if (error == nullptr) return out;
  out += ": boundary within " + percentText(error->boundaryDistance()) + " of the diagonal";
  const std::size_t shown = std::min(kShownFields, error->fields.size());
  const std::vector<bool> isLabel = labelsAmong(log->manifest);
  for (std::size_t f = 0; f < shown; ++f)
    out += ", " + fieldKey(log->manifest, f) + " " +
           fieldErrorText(fieldErrorJson(error->fields[f], isLabel[f]));
  if (shown < error->fields.size())
    out += ", and " + std::to_string(error->fields.size() - shown) + " more fields";
  return out;
}

CommandHelp pageHelp() {
  return {"page", "page FILE -o OUT.html [options]",
          R"(Writes one HTML file with the viewer and the log in it, to send by mail or to keep.
It opens by a double click, on a phone too, and fetches nothing.
A mesh becomes a log first, by the usual settings of qtet simplify.)",
          R"(  qtet page part.vtu -o part.html
  qtet page part.qtet -o part.html --max-bytes 5M
)"};
}

}  // namespace

int runPage(const Words& words, Console& console) {
  po::options_description options("options");
  options.add_options()("output,o", po::value<std::string>(),
                        "required: the page to write, NAME.html; or - for the standard output")(
      "viewer", po::value<std::string>(),
      "the viewer's files; without it those installed with qtet-server")(
      "view", po::value<std::string>()->default_value(""),
      "what it shows first, as behind the ? of the viewer's address: 'field=p&clip=x:0.5'")(
      "max-bytes", po::value<std::string>(),
      "no larger a page: instants of series are left out, every second one first, then fine "
      "levels; "
      "5000000, 500k, 5M")(
      "fields", po::value<std::string>()->default_value("all"),
      "of a mesh: all, none, or names between commas, as `qtet simplify --fields` takes them");
  addNoClobber(options);
  addReadOptions(options);
  const ParsedWords parsed(words, pageHelp(), options, {"FILE"});
  if (parsed.helped(console)) return kExitOk;
  const fs::path input = parsed.get<std::string>("FILE");
  const Output output = outputOf(parsed, console);
  if (Status checked = checkOutput(output, ".html", input); !checked)
    return reportFailure(checked.error(), false, console);
  const SinglePageOptions wanted{maxBytesOf(parsed), parsed.get<std::string>("view")};
  const GuardedFolder folder("page");
  if (Status isThere = folder.made(); !isThere)
    return reportFailure(isThere.error(), false, console);
  const fs::path log = folder.path() / (meshNameOf(input) + ".qtet");
  if (const int provided = provideLog(input, log, parsed, console); provided != kExitOk)
    return provided;
  const fs::path viewer =
      parsed.has("viewer") ? fs::path(parsed.get<std::string>("viewer")) : installation().viewer;
  const Result<MadePage> made = fittingPage(folder.path(), log, viewer, wanted);
  if (!made) return reportFailure(made.error(), false, console);
  const Result<SinglePage>& page = made->page;
  if (!page) return reportFailure(page.error(), false, console);
  std::string held = made->instants;
  if (page->chunks > 0) {
    const Result<std::string> part = heldPart(made->log, page->chunks);
    if (!part) return reportFailure(part.error(), false, console);
    held += *part;
  }
  if (Status written = writeOutput(output, page->bytes); !written)
    return reportFailure(written.error(), false, console);
  reportOutput(output,
               console.shown(output.name()) + ": " + grouped(page->bytes.size()) + " bytes" +
                   console.shown(held) + "\n",
               console);
  return kExitOk;
}

}  // namespace qtet
