#include "server/http/unwritable_level.h"

#include <string>
#include <string_view>
#include <utility>

namespace qtet {

Reply unwritableLevel(const Error& error) {
  constexpr std::pair<std::string_view, std::string_view> kParameters[] = {{"`fields`", "fields="},
                                                                           {"`time`", "time="}};
  std::string detail = error.message;
  for (const auto& [option, parameter] : kParameters)
    for (std::size_t at = 0; (at = detail.find(option, at)) != std::string::npos;
         at += parameter.size())
      detail.replace(at, option.size(), parameter);
  return problem(422, "unwritable-level", detail);
}

}  // namespace qtet
