// The router's answer to a request: a finished reply, or one whose body takes work first.
#pragma once

#include <utility>
#include <variant>

#include "server/http/http_message.h"
#include "server/store/level_request.h"
#include "server/wire/upload_request.h"

namespace qtet {

/// With a level to be made, `reply` is the head that its bytes go out with. With an upload to be
/// taken, the upload alone makes the reply, and this one says nothing.
struct Answer {
  using Work = std::variant<std::monostate, LevelRequest, UploadRequest>;

  // Most answers are one. NOLINTNEXTLINE(google-explicit-constructor)
  Answer(Reply whole) : reply(std::move(whole)) {}
  Answer(Reply head, LevelRequest level) : reply(std::move(head)), work(std::move(level)) {}
  explicit Answer(UploadRequest upload) : work(std::move(upload)) {}

  Reply reply{};
  Work work{};
};

}  // namespace qtet
