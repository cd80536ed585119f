// http_client.h of a program that was built without libcurl.
#include "simplify/remote/http_client.h"

namespace qtet {
namespace {

std::unexpected<Error> refusal() {
  return fail(ErrorCode::kIo,
              "this program was built without HTTP; send the log with `curl -T LOG -H "
              "'Authorization: Bearer TOKEN' http://HOST/v1/meshes/NAME`");
}

}  // namespace

Result<HttpUrl> parseHttpUrl(const std::string&) { return refusal(); }
std::string encodedSegment(const std::string& text) { return text; }
Result<HttpAnswer> exchange(const HttpUrl&, const HttpRequest&) { return refusal(); }

}  // namespace qtet
