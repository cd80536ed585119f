// The functions of the C++ library for files that its archive for WebAssembly lacks, and those for
// exceptions, which end the module.
#include <sys/stat.h>

#include <cerrno>
#include <filesystem>
#include <fstream>

extern "C" {
void* __cxa_allocate_exception(std::size_t) { __builtin_trap(); }
[[noreturn]] void __cxa_throw(void*, void*, void (*)(void*)) { __builtin_trap(); }
}

template class std::basic_filebuf<char>;
template class std::basic_ifstream<char>;

_LIBCPP_BEGIN_NAMESPACE_FILESYSTEM

namespace {

bool readStatus(const path& of, struct stat& into, error_code* code) {
  const bool isThere = ::stat(of.c_str(), &into) == 0;
  if (code) *code = isThere ? error_code() : error_code(errno, generic_category());
  return isThere;
}

}  // namespace

file_status __status(const path& of, error_code* code) {
  struct stat status{};
  if (!readStatus(of, status, code))
    return file_status(errno == ENOENT ? file_type::not_found : file_type::none);
  return file_status(S_ISDIR(status.st_mode) ? file_type::directory : file_type::regular);
}

uintmax_t __file_size(const path& of, error_code* code) {
  struct stat status{};
  return readStatus(of, status, code) ? static_cast<uintmax_t>(status.st_size) : 0;
}

_LIBCPP_END_NAMESPACE_FILESYSTEM
