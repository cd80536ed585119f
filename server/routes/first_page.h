// The viewer's page as it goes out, with the name and the poster of the mesh that it will show. Its
// head has links to what it will need.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "server/http/http_message.h"
#include "server/routes/kept_pages.h"
#include "server/routes/viewer_files.h"
#include "server/store/catalogue.h"
#include "server/wire/access.h"
#include "server/wire/request_target.h"

namespace qtet {

/// The mesh that the page at `target` shows first, as the poster shows it. nullptr if there is
/// none, if the address says more of the view, or if not everybody may read the mesh. Pages are
/// asked for without a token, so a guarded mesh looks like one that does not exist.
[[nodiscard]] EntryPointer meshOfPage(const RequestTarget& target, const Catalogue& catalogue,
                                      const MayRead& mayRead);

/// The value of a `Link` header: what the page itself names in its links and scripts. Empty if it
/// names nothing.
[[nodiscard]] std::string linksOf(std::string_view page);

/// The page with the mesh in it. `links` are those of the page, and `resource` describes it without
/// the mesh. `kept` keeps the compressed pages.
[[nodiscard]] Reply pageReply(const RequestView& request, const ViewerFile& page,
                              const MeshEntry& mesh, const std::string& links, Resource resource,
                              KeptPages& kept);

}  // namespace qtet
