// How much a file system still takes.
#pragma once

#include <sys/statvfs.h>

#include <cstdint>
#include <filesystem>
#include <functional>

namespace qtet {

namespace limits {
/// Bytes of a disk below which no upload is begun and no level is kept: for the access log, and for
/// what else lives there.
inline constexpr std::uintmax_t kDiskReserve = std::uintmax_t{256} << 20;
}  // namespace limits

/// Bytes that may still be written where `path` lies; as many as there can be where it cannot be
/// found out.
[[nodiscard]] inline std::uintmax_t freeDiskBytes(const std::filesystem::path& path) {
  struct statvfs info{};
  if (::statvfs(path.c_str(), &info) != 0) return ~std::uintmax_t{0};
  return std::uintmax_t{info.f_bavail} * info.f_frsize;
}
using FreeDiskBytes = std::function<std::uintmax_t(const std::filesystem::path&)>;

}  // namespace qtet
