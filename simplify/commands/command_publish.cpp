#include <algorithm>

#include "simplify/commands/tool_main.h"
#include "simplify/log/opened_list.h"
#include "simplify/publish/publish_site.h"
#include "simplify/publish/site_folder.h"
#include "simplify/words/json_report.h"
#include "simplify/words/output.h"
#include "simplify/words/parsed_words.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

/// Logs, and lists of logs, whose names can be shown and be part of an address.
std::vector<fs::path> logsOf(const ParsedWords& parsed) {
  std::vector<fs::path> logs;
  for (const std::string& word : parsed.get<std::vector<std::string>>("LOG...")) {
    const std::string name = fs::path(word).filename().string();
    if (name == kSiteList)
      throw UsageError("'" + word + "' has the name of the folder's own list; rename it");
    if ((!name.ends_with(".qtet") || name == ".qtet") && !isSegmentList(word))
      throw UsageError("'" + word +
                       "' is no log NAME.qtet and no list of logs NAME.json; make one with qtet "
                       "simplify");
    if (printable(name) != name)
      throw UsageError("'" + word + "' has a name that no address can hold; rename it");
    logs.emplace_back(word);
  }
  return logs;
}

OrderedJson toJson(const std::string& folder, const PublishedSite& site) {
  OrderedJson meshes = OrderedJson::array();
  for (const PublishedMesh& mesh : site.meshes)
    meshes.push_back({{"name", mesh.name}, {"bytes", mesh.bytes}, {"tetrahedra", mesh.tetrahedra}});
  return {{"output", folder}, {"files", site.files}, {"bytes", site.bytes}, {"meshes", meshes}};
}

CommandHelp publishHelp() {
  return {"publish", "publish FOLDER LOG... [--viewer DIR] [--plain] [--json]",
          R"(Writes a folder that any web server can serve as it is, without a program of ours: the
viewer, compressed too, the logs NAME.qtet and those of lists NAME.json, index.json with their list,
and README.txt with the settings for nginx, Caddy, S3 with CloudFront, and GitHub Pages.
The folder appears whole or not at all.
One that an earlier publish made is replaced as a whole, logs included; a folder that holds anything
else is refused.
--json: output, files, bytes, meshes [{name, bytes, tetrahedra}].)",
          R"(  qtet publish site fin.qtet
  qtet publish /var/www/meshes logs/*.qtet
)"};
}

}  // namespace

int runPublish(const Words& words, Console& console) {
  po::options_description options("options");
  options.add_options()("viewer", po::value<std::string>(),
                        "the viewer's files; without it those installed with qtet-server")(
      "plain", "without NAME.gz and NAME.br, for a server that compresses by itself")(
      "json", "print one JSON object");
  addNoClobber(options);
  const ParsedWords parsed(words, publishHelp(), options, {"FOLDER", "LOG..."});
  if (parsed.helped(console)) return kExitOk;
  const auto folder = parsed.get<std::string>("FOLDER");
  if (Status kept = checkKeepsOld({folder, parsed.has("no-clobber")}); !kept)
    return reportFailure(kept.error(), parsed.has("json"), console);
  const fs::path viewer =
      parsed.has("viewer") ? fs::path(parsed.get<std::string>("viewer")) : installation().viewer;
  const Result<PublishedSite> site =
      publishSite(folder, viewer, logsOf(parsed),
                  parsed.has("plain") ? Codings::kNone : Codings::kGzipAndBrotli);
  if (!site) return reportFailure(site.error(), parsed.has("json"), console);
  if (parsed.has("json")) {
    printJson(toJson(folder, *site), console);
    return kExitOk;
  }
  console.out << console.shown(folder) << ": " << counted(site->meshes.size(), "mesh", "meshes")
              << ", " << counted(site->files, "file", "files") << ", " << grouped(site->bytes)
              << " bytes; README.txt there says how to serve it\n";
  return kExitOk;
}

}  // namespace qtet
