// The answer to a preflight, by which a browser asks whether a page may send a request.
#pragma once

#include <string>
#include <vector>

#include "server/session/http_request.h"

namespace qtet {

/// Makes the answer to OPTIONS say what holds for the page of the request's Origin: originRefusal()
/// for changes, everything for reading. Other answers stay as they are, and so does everything
/// where `origins` is nullptr or empty.
void answerForOrigin(Reply& reply, const RequestHeader& header,
                     const std::vector<std::string>* origins);

}  // namespace qtet
