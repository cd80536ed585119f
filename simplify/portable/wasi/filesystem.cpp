// The functions of the C++ library for files that its archive for WebAssembly lacks: those of them
// that are used here. A name that a link has is the link's, as everywhere in WASI.
#include <dirent.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <vector>

template class std::basic_filebuf<char>;
template class std::basic_ifstream<char>;
template class std::basic_ofstream<char>;

_LIBCPP_BEGIN_NAMESPACE_FILESYSTEM

namespace {

/// Hands errno over, or throws it where nobody takes it. Returns whether `done`.
bool told(bool done, error_code* code) {
  const error_code now = done ? error_code() : error_code(errno, generic_category());
  if (code != nullptr) *code = now;
  if (!done && code == nullptr) throw system_error(now);
  return done;
}

file_type typeOf(mode_t mode) {
  if (S_ISDIR(mode)) return file_type::directory;
  if (S_ISLNK(mode)) return file_type::symlink;
  if (S_ISCHR(mode)) return file_type::character;
  if (S_ISFIFO(mode)) return file_type::fifo;
  return file_type::regular;
}

bool isMissing() { return errno == ENOENT || errno == ENOTDIR; }

/// A missing file is no error.
template <class Look>
file_status statusOf(const path& of, error_code* code, const Look& look) {
  struct stat status{};
  const bool isThere = look(of.c_str(), &status) == 0;
  const file_type without = isMissing() ? file_type::not_found : file_type::none;
  if (isThere || without == file_type::none) told(isThere, code);
  if (!isThere && code != nullptr) *code = error_code(errno, generic_category());
  return isThere ? file_status(typeOf(status.st_mode), perms(status.st_mode & 07777))
                 : file_status(without);
}

}  // namespace

file_status __status(const path& of, error_code* code) { return statusOf(of, code, ::stat); }
file_status __symlink_status(const path& of, error_code* code) {
  return statusOf(of, code, ::lstat);
}

uintmax_t __file_size(const path& of, error_code* code) {
  struct stat status{};
  return told(::stat(of.c_str(), &status) == 0, code) ? static_cast<uintmax_t>(status.st_size)
                                                      : static_cast<uintmax_t>(-1);
}

bool __equivalent(const path& one, const path& other, error_code* code) {
  struct stat a{}, b{};
  return told(::stat(one.c_str(), &a) == 0 && ::stat(other.c_str(), &b) == 0, code) &&
         a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

path __read_symlink(const path& of, error_code* code) {
  char target[PATH_MAX];
  const ssize_t bytes = ::readlink(of.c_str(), target, sizeof target);
  return told(bytes >= 0, code) ? path(target, target + bytes) : path();
}

path __current_path(error_code* code) {
  char name[PATH_MAX];
  return told(::getcwd(name, sizeof name) != nullptr, code) ? path(name) : path();
}

path __absolute(const path& of, error_code* code) {
  if (code != nullptr) code->clear();
  return of.is_absolute() ? of : __current_path(code) / of;
}

/// Without the links that WASI follows by itself.
path __canonical(const path& of, error_code* code) {
  struct stat status{};
  return told(::stat(of.c_str(), &status) == 0, code) ? __absolute(of, code).lexically_normal()
                                                      : path();
}
path __weakly_canonical(const path& of, error_code* code) {
  return __absolute(of, code).lexically_normal();
}

path __temp_directory_path(error_code* code) {
  const char* name = std::getenv("TMPDIR");
  const path folder = name != nullptr && *name != '\0' ? name : "/tmp";
  struct stat status{};
  bool isThere = ::stat(folder.c_str(), &status) == 0;
  if (isThere && !S_ISDIR(status.st_mode)) {
    isThere = false;
    errno = ENOTDIR;
  }
  return told(isThere, code) ? folder : path();
}

bool __create_directory(const path& name, error_code* code) {
  if (::mkdir(name.c_str(), 0777) == 0) return told(true, code);
  const int why = errno;
  error_code ignored;
  if (why == EEXIST && __status(name, &ignored).type() == file_type::directory) {
    told(true, code);
    return false;
  }
  errno = why;
  return told(false, code);
}

bool __create_directories(const path& name, error_code* code) {
  error_code ignored;
  if (__status(name, &ignored).type() == file_type::directory) {
    told(true, code);
    return false;
  }
  const path above = name.parent_path();
  if (!above.empty() && above != name) {
    __create_directories(above, code);
    if (code != nullptr && *code) return false;
  }
  return __create_directory(name, code);
}

bool __remove(const path& name, error_code* code) {
  if (::remove(name.c_str()) == 0) return told(true, code);
  const bool wasMissing = isMissing();
  told(wasMissing, code);
  return false;
}

uintmax_t __remove_all(const path& name, error_code* code) {
  error_code failed;
  uintmax_t count = 0;
  if (__symlink_status(name, &failed).type() == file_type::directory) {
    vector<path> within;
    for (directory_iterator at(name, failed), end; !failed && at != end; at.increment(failed))
      within.push_back(at->path());
    for (const path& one : within) {
      count += __remove_all(one, code);
      if (code != nullptr && *code) return count;
    }
  }
  return count + (__remove(name, code) ? 1 : 0);
}

void __rename(const path& from, const path& to, error_code* code) {
  told(::rename(from.c_str(), to.c_str()) == 0, code);
}

void __create_hard_link(const path& to, const path& link, error_code* code) {
  told(::link(to.c_str(), link.c_str()) == 0, code);
}

/// No options are known: a file that is there is not replaced.
bool __copy_file(const path& from, const path& to, copy_options, error_code* code) {
  struct stat status{};
  if (::stat(to.c_str(), &status) == 0) {
    errno = EEXIST;
    return told(false, code);
  }
  ifstream in(from, ios::binary);
  if (!in.is_open()) return told(false, code);
  ofstream out(to, ios::binary);
  if (!out.is_open()) return told(false, code);
  if (in.peek() != ifstream::traits_type::eof()) out << in.rdbuf();
  return told(!in.bad() && out.flush(), code);
}

// ---- folders

/// Nothing is kept: who asks looks at the file.
error_code directory_entry::__do_refresh() noexcept {
  __data_.__reset();
  error_code code;
  __symlink_status(__p_, &code);
  return code;
}

class __dir_stream {
 public:
  __dir_stream(const path& folder, error_code* code)
      : folder_(folder), names_(::opendir(folder.c_str())) {
    if (told(names_ != nullptr, code)) told(next(), code);
  }
  __dir_stream(const __dir_stream&) = delete;
  __dir_stream& operator=(const __dir_stream&) = delete;
  ~__dir_stream() {
    if (names_ != nullptr) ::closedir(names_);
  }

  bool isAtEnd() const { return names_ == nullptr || isAtEnd_; }
  const directory_entry& entry() const { return entry_; }

  /// Returns whether the folder could be read.
  bool next() {
    const dirent* found = nullptr;
    do {
      errno = 0;
      found = ::readdir(names_);
    } while (found != nullptr && (path(found->d_name) == "." || path(found->d_name) == ".."));
    isAtEnd_ = found == nullptr;
    error_code ignored;
    if (found != nullptr) entry_.assign(folder_ / found->d_name, ignored);
    return found != nullptr || errno == 0;
  }

 private:
  path folder_;
  DIR* names_;
  directory_entry entry_;
  bool isAtEnd_ = false;
};

directory_iterator::directory_iterator(const path& folder, error_code* code, directory_options)
    : __imp_(make_shared<__dir_stream>(folder, code)) {
  if (__imp_->isAtEnd()) __imp_.reset();
}
directory_iterator& directory_iterator::__increment(error_code* code) {
  told(__imp_->next(), code);
  if (__imp_->isAtEnd()) __imp_.reset();
  return *this;
}
const directory_entry& directory_iterator::__dereference() const { return __imp_->entry(); }

struct recursive_directory_iterator::__shared_imp {
  vector<directory_iterator> open;
};

recursive_directory_iterator::recursive_directory_iterator(const path& folder, directory_options,
                                                           error_code* code)
    : __rec_(true) {
  const directory_iterator first =
      code != nullptr ? directory_iterator(folder, *code) : directory_iterator(folder);
  if (first != directory_iterator()) __imp_ = make_shared<__shared_imp>(__shared_imp{{first}});
}
recursive_directory_iterator& recursive_directory_iterator::__increment(error_code* code) {
  told(true, code);
  vector<directory_iterator>& open = __imp_->open;
  const directory_entry& here = *open.back();
  directory_iterator within;
  error_code failed;
  if (here.symlink_status(failed).type() == file_type::directory)
    within = directory_iterator(here.path(), failed);
  ++open.back();
  if (within != directory_iterator()) open.push_back(within);
  while (!open.empty() && open.back() == directory_iterator()) open.pop_back();
  if (open.empty()) __imp_.reset();
  return *this;
}
const directory_entry& recursive_directory_iterator::__dereference() const {
  return *__imp_->open.back();
}

_LIBCPP_END_NAMESPACE_FILESYSTEM
