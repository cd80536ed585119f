#include "simplify/read/hdf/hdf_file.h"

#include <hdf5.h>

#include <algorithm>
#include <array>
#include <utility>

#include "codec/coding/float_bits.h"

namespace qtet {
namespace {

static_assert(std::is_same_v<hid_t, std::int64_t>);

/// Deflate gives at most 1,032 bytes for one (RFC 1951: 258 bytes for two bits).
constexpr std::uint64_t kMaxInflation = 1032;

/// An object of the library, closed with this.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t id, Close close) : id_(id), close_(close) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  [[nodiscard]] hid_t id() const { return id_; }
  explicit operator bool() const { return id_ >= 0; }

 private:
  hid_t id_;
  Close close_;
};

std::string typeName(hid_t type) {
  const std::size_t bits = 8 * H5Tget_size(type);
  switch (H5Tget_class(type)) {
    case H5T_FLOAT: return bits <= 32 ? "float32" : "float64";
    case H5T_INTEGER:
      if (bits > 64) return {};
      return (H5Tget_sign(type) == H5T_SGN_NONE ? "uint" : "int") + std::to_string(bits);
    default: return {};
  }
}

/// Whether only filters that inflate by at most kMaxInflation lie between the bytes and the array.
bool isBounded(hid_t set) {
  const Handle plan(H5Dget_create_plist(set), H5Pclose);
  const int filters = plan ? H5Pget_nfilters(plan.id()) : 0;
  for (unsigned i = 0; std::cmp_less(i, filters); ++i) {
    std::size_t values = 0;
    unsigned flags = 0, config = 0;
    const H5Z_filter_t filter =
        H5Pget_filter2(plan.id(), i, &flags, &values, nullptr, 0, nullptr, &config);
    if (filter != H5Z_FILTER_DEFLATE && filter != H5Z_FILTER_SHUFFLE &&
        filter != H5Z_FILTER_FLETCHER32)
      return false;
  }
  return true;
}

}  // namespace

Result<HdfFile> HdfFile::open(const std::filesystem::path& path) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors come as values, not as text on stderr
  const hid_t id = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (id < 0)
    return fail(ErrorCode::kBadInput,
                path.string() + ": it is no file of HDF5, or a damaged one; export the mesh again");
  return HdfFile(path, id);
}

HdfFile::HdfFile(HdfFile&& other) noexcept
    : path_(std::move(other.path_)), id_(std::exchange(other.id_, -1)) {}

HdfFile::~HdfFile() {
  if (id_ >= 0) H5Fclose(id_);
}

std::unexpected<Error> HdfFile::bad(const std::string& what) const {
  return fail(ErrorCode::kBadInput, path_.string() + ": " + what);
}

bool HdfFile::has(const std::string& name) const {
  for (std::size_t end = 0; end != std::string::npos;) {
    end = name.find('/', end + 1);
    if (H5Lexists(id_, name.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
  }
  return H5Oexists_by_name(id_, name.c_str(), H5P_DEFAULT) > 0;
}

std::vector<std::string> HdfFile::arraysIn(const std::string& group) const {
  std::vector<std::string> out;
  if (!has(group)) return out;
  const Handle in(H5Gopen2(id_, group.c_str(), H5P_DEFAULT), H5Gclose);
  H5G_info_t info{};
  if (!in || H5Gget_info(in.id(), &info) < 0) return out;
  for (hsize_t i = 0; i < info.nlinks; ++i) {
    const auto nameAt = [&](char* into, std::size_t room) {
      return H5Lget_name_by_idx(in.id(), ".", H5_INDEX_NAME, H5_ITER_INC, i, into, room,
                                H5P_DEFAULT);
    };
    const ssize_t length = nameAt(nullptr, 0);
    if (length <= 0) continue;
    std::string name(static_cast<std::size_t>(length) + 1, '\0');
    nameAt(name.data(), name.size());
    name.pop_back();
    const Handle object(H5Oopen(in.id(), name.c_str(), H5P_DEFAULT), H5Oclose);
    if (object && H5Iget_type(object.id()) == H5I_DATASET) out.push_back(std::move(name));
  }
  return out;
}

std::optional<std::string> HdfFile::textOf(const std::string& group, const char* attribute) const {
  if (!has(group) || H5Aexists_by_name(id_, group.c_str(), attribute, H5P_DEFAULT) <= 0)
    return std::nullopt;
  const Handle at(H5Aopen_by_name(id_, group.c_str(), attribute, H5P_DEFAULT, H5P_DEFAULT),
                  H5Aclose);
  const Handle type(at ? H5Aget_type(at.id()) : -1, H5Tclose);
  const Handle space(at ? H5Aget_space(at.id()) : -1, H5Sclose);
  if (!type || H5Tget_class(type.id()) != H5T_STRING || !space ||
      H5Sget_simple_extent_npoints(space.id()) != 1)
    return std::nullopt;
  if (H5Tis_variable_str(type.id()) > 0) {
    char* text = nullptr;
    const Handle inMemory(H5Tget_native_type(type.id(), H5T_DIR_DEFAULT), H5Tclose);
    if (H5Aread(at.id(), inMemory.id(), &text) < 0 || !text) return std::nullopt;
    std::string out = text;
    H5free_memory(text);
    return out;
  }
  constexpr std::size_t kMaxBytes = 4096;  // of a name; longer ones are damage
  const std::size_t bytes = H5Tget_size(type.id());
  if (bytes > kMaxBytes) return std::nullopt;
  std::string out(bytes, '\0');
  if (H5Aread(at.id(), type.id(), out.data()) < 0) return std::nullopt;
  out.resize(std::min(out.find('\0'), out.size()));
  return out;
}

Result<HdfArray> HdfFile::array(const std::string& name) const {
  const Handle set(has(name) ? H5Dopen2(id_, name.c_str(), H5P_DEFAULT) : -1, H5Dclose);
  if (!set) return bad("it has no array " + name + "; export the mesh again");
  const Handle space(H5Dget_space(set.id()), H5Sclose);
  const Handle type(H5Dget_type(set.id()), H5Tclose);
  std::array<hsize_t, H5S_MAX_RANK> shape{};
  const int dimensions = space ? H5Sget_simple_extent_dims(space.id(), shape.data(), nullptr) : -1;
  if (dimensions < 0 || !type)
    return bad("its array " + name + " is damaged; export the mesh again");
  HdfArray out{name, dimensions == 0 ? 1 : shape[0], 1, typeName(type.id())};
  std::uint64_t bytes = H5Tget_size(type.id());
  bool fits = !__builtin_mul_overflow(bytes, out.rows, &bytes);
  for (std::size_t i = 1; std::cmp_less(i, dimensions); ++i) {
    fits = fits && !__builtin_mul_overflow(bytes, shape[i], &bytes);
    out.columns *= shape[i];
  }
  const std::uint64_t stored = H5Dget_storage_size(set.id());
  if (!fits || (isBounded(set.id()) && bytes / kMaxInflation > stored))
    return bad("its array " + name + " has " + std::to_string(stored) +
               " bytes in the file, which cannot hold the numbers that it should have; export the "
               "mesh again");
  return out;
}

template <class T>
Status HdfFile::read(const HdfArray& array, std::uint64_t first, std::uint64_t count,
                     std::int64_t type, std::vector<T>& out) const {
  if (array.type.empty()) return bad("its array " + array.name + " holds no numbers");
  if (first > array.rows || count > array.rows - first)
    return bad("its array " + array.name + " has " + std::to_string(array.rows) +
               " rows, but the file's counts say at least " + std::to_string(first) + " and " +
               std::to_string(count) + " more; export the mesh again");
  out.resize(count * array.columns);
  if (out.empty()) return {};
  const Handle set(H5Dopen2(id_, array.name.c_str(), H5P_DEFAULT), H5Dclose);
  const Handle space(set ? H5Dget_space(set.id()) : -1, H5Sclose);
  std::array<hsize_t, H5S_MAX_RANK> from{}, rows{};
  const int dimensions = space ? H5Sget_simple_extent_dims(space.id(), rows.data(), nullptr) : -1;
  from[0] = first;
  if (dimensions > 0) rows[0] = count;
  const hsize_t numbers = out.size();
  const Handle inMemory(H5Screate_simple(1, &numbers, nullptr), H5Sclose);
  if (dimensions < 0 || !inMemory ||
      (dimensions > 0 && H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, from.data(), nullptr,
                                             rows.data(), nullptr) < 0) ||
      H5Dread(set.id(), type, inMemory.id(), space.id(), H5P_DEFAULT, out.data()) < 0)
    return bad("its array " + array.name +
               " cannot be read: the file is cut off or damaged, or a filter of HDF5 that it "
               "needs is not installed");
  return {};
}

Result<std::vector<double>> HdfFile::reals(const HdfArray& array, std::uint64_t first,
                                           std::uint64_t count) const {
  std::vector<double> out;
  if (array.type != "float32") {
    const Status done = read(array, first, count, H5T_NATIVE_DOUBLE, out);
    return done ? Result<std::vector<double>>(std::move(out)) : std::unexpected(done.error());
  }
  std::vector<float> narrow;
  if (Status done = read(array, first, count, H5T_NATIVE_FLOAT, narrow); !done)
    return std::unexpected(done.error());
  out.resize(narrow.size());
  std::ranges::transform(narrow, out.begin(), widened);
  return out;
}

Result<std::vector<std::int64_t>> HdfFile::integers(const HdfArray& array, std::uint64_t first,
                                                    std::uint64_t count) const {
  std::vector<std::int64_t> out;
  if (array.type.starts_with("float"))
    return bad("its array " + array.name + " holds floats in place of integers");
  const Status done = read(array, first, count, H5T_NATIVE_INT64, out);
  if (!done) return std::unexpected(done.error());
  return out;
}

Result<std::vector<std::int64_t>> HdfFile::allIntegers(const std::string& name) const {
  const auto found = array(name);
  return found ? integers(*found, 0, found->rows) : std::unexpected(found.error());
}

Result<std::vector<double>> HdfFile::allReals(const std::string& name) const {
  const auto found = array(name);
  return found ? reals(*found, 0, found->rows) : std::unexpected(found.error());
}

}  // namespace qtet
