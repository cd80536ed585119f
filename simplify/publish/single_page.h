// A published folder as one HTML file, which opens from a disk.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "proto/bytes.h"
#include "proto/error.h"

namespace qtet {

/// Browsers hold a page's text in memory as a whole, and some end at half of 2^30 characters.
inline constexpr std::uint64_t kMaxPageBytes = 256u << 20;

struct SinglePageOptions {
  std::optional<std::uint64_t> maxBytes = std::nullopt;
  /// The first view, as behind the ? of the viewer's address.
  std::string view{};
};

struct SinglePage {
  Bytes bytes;
  /// So many leading chunks of the log are in the page, which holds a part of it; 0: all.
  std::uint32_t chunks = 0;
};

/// The page of a folder that publishSite made of one log, without codings. It holds the files in
/// base64, all but the log by gzip. Its first script (web-client/public/single_page.js) unpacks
/// them and starts the viewer. Nothing is fetched: the page's own policy forbids it. It holds as
/// many of the log's chunks as fit into `maxBytes` and kMaxPageBytes. Errors: io (a file cannot be
/// read), bad-input (a viewer of another version), limit-exceeded (the base mesh does not fit; the
/// message tells the smallest page's bytes).
[[nodiscard]] Result<SinglePage> singlePage(const std::filesystem::path& site,
                                            const SinglePageOptions& options = {});

}  // namespace qtet
