// Advice on how a web server should serve a published folder, for whoever runs it.
#pragma once

#include <string>

namespace qtet {

/// README.txt of the folder: what it is, and the lines for nginx, Caddy, S3 with CloudFront, and
/// GitHub Pages. The block for nginx stands between "nginx:" and the next line without indent.
[[nodiscard]] std::string hostingNotes();

}  // namespace qtet
