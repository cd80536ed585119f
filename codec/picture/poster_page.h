// The viewer's page with a mesh's name and poster, which a browser shows before any script comes.
#pragma once

#include <string>
#include <string_view>

namespace qtet {

/// The marks in the viewer's index.html that give way to the name and the poster.
inline constexpr std::string_view kNameMark = "<!--mesh-name-->";
inline constexpr std::string_view kPosterMark = "<!--mesh-poster-->";

/// `text` for HTML, between tags or in quotes.
[[nodiscard]] std::string htmlEscaped(std::string_view text);

/// Replaces the marks, where the page has them. `address` of the poster is percent-encoded.
[[nodiscard]] std::string pageOfMesh(std::string_view page, std::string_view name,
                                     std::string_view address);

}  // namespace qtet
