#include "server/http/log_check.h"

#include <exception>
#include <new>
#include <string>

#include "codec/log/decoding_memory.h"
#include "codec/refine/verify_log.h"

namespace qtet {
namespace {

Reply tooLarge(const std::string& detail) { return problem(413, "content-too-large", detail); }
Reply notSound(const std::string& detail) {
  return problem(422, "bad-log", "this is no sound log: " + detail);
}

std::optional<Reply> decodeWithin(const ServedMesh& mesh, const CheckLimits& limits,
                                  const std::stop_token& stop) {
  const auto end = std::chrono::steady_clock::now() + limits.time;
  const auto late = [end] { return std::chrono::steady_clock::now() >= end; };
  bool gaveUp = false;
  const auto goOn = [&](double) { return !(gaveUp = stop.stop_requested() || late()); };
  const Result<Refiner> decoded = decodeVerified(mesh.log, mesh.manifest, goOn);
  if (decoded) return std::nullopt;
  if (!gaveUp) return notSound(decoded.error().text());
  if (stop.stop_requested()) return busyReply("the check was broken off");
  const auto seconds = std::chrono::ceil<std::chrono::seconds>(limits.time).count();
  return tooLarge("this log could not be checked within the " + std::to_string(seconds) +
                  " s that this server has for it (its option --max-check-seconds)");
}

}  // namespace

std::optional<Reply> checkLog(const ServedMesh& mesh, const CheckLimits& limits,
                              const std::stop_token& stop) {
  if (const std::uint64_t bytes = decodingBytes(mesh.log.index()); bytes > limits.bytes)
    return tooLarge("checking this log takes " + std::to_string(bytes) +
                    " bytes of memory, more than the " + std::to_string(limits.bytes) +
                    " that this server has for it (its option --max-check-bytes)");
  try {
    return decodeWithin(mesh, limits, stop);
  } catch (const std::bad_alloc&) {
    return busyReply("there is not enough memory to check this log now; try again");
  } catch (const std::exception& error) {  // of a library
    return notSound(error.what());
  }
}

}  // namespace qtet
