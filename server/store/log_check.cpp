#include "server/store/log_check.h"

#include <exception>
#include <new>
#include <string>

#include "codec/log/decoding_memory.h"
#include "codec/refine/verify_log.h"

namespace qtet {
namespace {

using End = CheckVerdict::End;

CheckVerdict notSound(const std::string& fault) {
  return {End::kUnsound, "this is no sound log: " + fault};
}

CheckVerdict decodeWithin(const ServedMesh& mesh, const CheckLimits& limits,
                          const std::stop_token& stop) {
  const auto end = std::chrono::steady_clock::now() + limits.time;
  const auto late = [end] { return std::chrono::steady_clock::now() >= end; };
  bool gaveUp = false;
  const auto goOn = [&](double) { return !(gaveUp = stop.stop_requested() || late()); };
  const Result<Refiner> decoded = decodeVerified(mesh.log, mesh.manifest, goOn);
  if (decoded) return {};
  if (!gaveUp) return notSound(decoded.error().text());
  if (stop.stop_requested()) return {End::kBusy, "the check was broken off"};
  const auto seconds = std::chrono::ceil<std::chrono::seconds>(limits.time).count();
  return {End::kTooLarge, "this log could not be checked within the " + std::to_string(seconds) +
                              " s that this server has for it (its option --max-check-seconds)"};
}

}  // namespace

CheckVerdict checkLog(const ServedMesh& mesh, const CheckLimits& limits,
                      const std::stop_token& stop) {
  if (const std::uint64_t bytes = decodingBytes(mesh.log.index()); bytes > limits.bytes)
    return {End::kTooLarge, "checking this log takes " + std::to_string(bytes) +
                                " bytes of memory, more than the " + std::to_string(limits.bytes) +
                                " that this server has for it (its option --max-check-bytes)"};
  try {
    return decodeWithin(mesh, limits, stop);
  } catch (const std::bad_alloc&) {
    return {End::kBusy, "there is not enough memory to check this log now; try again"};
  } catch (const std::exception& error) {  // of a library
    return notSound(error.what());
  }
}

}  // namespace qtet
