// Logs with the viewer as a folder that any web server can serve.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "proto/error.h"

namespace qtet {

struct PublishedMesh {
  std::string name;  ///< the file's name without .qtet, or of a list without .json
  std::uint64_t bytes = 0, tetrahedra = 0;
};

struct PublishedSite {
  std::vector<PublishedMesh> meshes;
  std::size_t files = 0;
  std::uint64_t bytes = 0;
};

/// Which compressed copies lie beside the viewer's files.
enum class Codings { kNone, kGzipAndBrotli };

/// Makes `folder` of the viewer's files and the logs. It holds each file of the viewer, and with
/// codings NAME.gz and NAME.br beside it where that is smaller. It also holds NAME.qtet and its
/// poster NAME.webp (codec/picture/poster.h) for each log, index.json, README.txt
/// (hosting_notes.h) and .nojekyll.
/// index.json is a list as `GET /v1/meshes` gives it (PROTOCOL.md), with `links.log` and
/// `links.poster` relative to it, `firstBytes` (the length of the log's prefix that the viewer's
/// first picture takes), and `files`. `logs` may also have lists of segments NAME.json
/// (proto/SEGMENT_LIST.md); the folder then holds the list and its logs. Such a list is one mesh of
/// index.json, with the values of its first log, `links.list` and `segments`. A meta element gives
/// the page index.json as its list. The page holds the name and the poster of the first log
/// (codec/picture/poster_page.h). The same inputs give the same bytes. The folder appears whole or
/// not at all (site_folder.h). Errors: not-found and io (of files), those of openLog, openList,
/// openSegment and LogFile::verifyChecksums, bad-input (two logs of one name; a viewer without a
/// page).
[[nodiscard]] Result<PublishedSite> publishSite(const std::filesystem::path& folder,
                                                const std::filesystem::path& viewer,
                                                const std::vector<std::filesystem::path>& logs,
                                                Codings codings);

}  // namespace qtet
