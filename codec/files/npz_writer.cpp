#include <limits>
#include <set>
#include <string>

#include "codec/coding/number_type.h"
#include "codec/files/mesh_file.h"
#include "codec/mesh/boundary.h"

namespace qtet {
namespace {

// APPNOTE.TXT of ZIP, 4.3.7, 4.3.12, 4.3.16; NEP 1 for .npy.
constexpr std::uint32_t kLocalHeader = 0x04034B50, kCentralHeader = 0x02014B50,
                        kEndOfCentral = 0x06054B50;
constexpr std::uint16_t kZipVersion = 20, kUtf8Names = 1 << 11;
/// 1980-01-01, the earliest date of the format: the bytes do not depend on the time.
constexpr std::uint16_t kFirstDay = (1 << 5) | 1;
/// Arrays begin at multiples of this in a .npy, as numpy promises to programs that map it, and so
/// in the archive.
constexpr std::size_t kAlignment = 64;

constexpr std::array<std::uint32_t, 256> kCrcTable = [] {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t c = i;
    for (int k = 0; k < 8; ++k) c = (c >> 1) ^ ((c & 1) != 0 ? 0xEDB88320u : 0u);
    table[i] = c;
  }
  return table;
}();

/// CRC-32 as ZIP has it (not the CRC-32C of logs).
std::uint32_t zipCrc(ByteView bytes) {
  std::uint32_t crc = 0xFFFFFFFFu;
  for (const std::uint8_t b : bytes) crc = kCrcTable[(crc ^ b) & 0xFF] ^ (crc >> 8);
  return ~crc;
}

/// An archive of stored files.
class Zip {
 public:
  void add(const std::string& name, ByteView content) {
    tooLarge_ |= content.size() >= kMax || out_.size() >= kMax - content.size();
    if (tooLarge_) return;
    Bytes about;  // what the local and the central header share
    appendNumber(about, kZipVersion);
    appendNumber(about, kUtf8Names);
    // stored; midnight
    for (const std::uint16_t word : {std::uint16_t{0}, std::uint16_t{0}, kFirstDay})
      appendNumber(about, word);
    appendNumber(about, zipCrc(content));
    for (int both = 0; both < 2; ++both)
      appendNumber(about, static_cast<std::uint32_t>(content.size()));
    appendNumber(about, static_cast<std::uint16_t>(name.size()));
    appendNumber(about, std::uint16_t{0});

    appendNumber(central_, kCentralHeader);
    appendNumber(central_, kZipVersion);
    central_.insert(central_.end(), about.begin(), about.end());
    // no comment, disk 0, no text
    for (int zero = 0; zero < 3; ++zero) appendNumber(central_, std::uint16_t{0});
    appendNumber(central_, std::uint32_t{0});
    appendNumber(central_, static_cast<std::uint32_t>(out_.size()));
    appendText(central_, name);

    appendNumber(out_, kLocalHeader);
    out_.insert(out_.end(), about.begin(), about.end());
    appendText(out_, name);
    out_.insert(out_.end(), content.begin(), content.end());
    ++files_;
  }
  [[nodiscard]] Result<Bytes> finish() {
    const std::size_t at = out_.size();
    if (tooLarge_ || at + central_.size() >= kMax)
      return fail(
          ErrorCode::kBadInput,
          "the mesh takes more than the 4 GiB of a .npz file; leave fields out, or write .vtu");
    out_.insert(out_.end(), central_.begin(), central_.end());
    appendNumber(out_, kEndOfCentral);
    appendNumber(out_, std::uint32_t{0});
    for (int both = 0; both < 2; ++both) appendNumber(out_, files_);
    appendNumber(out_, static_cast<std::uint32_t>(central_.size()));
    appendNumber(out_, static_cast<std::uint32_t>(at));
    appendNumber(out_, std::uint16_t{0});
    return std::move(out_);
  }

 private:
  static constexpr std::size_t kMax = std::numeric_limits<std::uint32_t>::max();

  Bytes out_, central_;
  std::uint16_t files_ = 0;
  bool tooLarge_ = false;
};

/// The beginning of a .npy file of `rows` rows; one column is a plain array.
Bytes npyStart(std::string_view type, std::size_t rows, std::size_t columns) {
  std::string header = "{'descr': '" + std::string(type) + "', 'fortran_order': False, 'shape': (" +
                       std::to_string(rows) + "," +
                       (columns == 1 ? "" : " " + std::to_string(columns)) + "), }";
  constexpr std::size_t kBefore = 10;  // magic, version, length of the header
  header.resize((kBefore + header.size() + kAlignment) / kAlignment * kAlignment - kBefore, ' ');
  header.back() = '\n';
  const auto low = static_cast<char>(header.size() & 0xFF),
             high = static_cast<char>(header.size() >> 8);
  header = std::string("\x93NUMPY\1\0", 8) + low + high + header;
  return {header.begin(), header.end()};
}

template <class Tuples>
Bytes npyOfIds(const Tuples& tuples, std::size_t columns) {
  Bytes out = npyStart("<u4", tuples.size(), columns);
  for (const auto& tuple : tuples)
    for (const VertexId v : tuple) appendNumber(out, v);
  return out;
}

void addFields(Zip& zip, const std::string& prefix, const std::vector<FileField>& fields,
               std::set<std::string>& taken) {
  for (const FileField& field : fields) {
    std::string name = prefix + field.name;
    for (char& c : name)
      if (c == '/' || c == '\\' || c == '\0') c = '_';
    while (!taken.insert(name).second) name += "_";
    const NumberType& type = numberType(field.type);
    Bytes content =
        npyStart(type.numpyName, field.values.size() / field.components, field.components);
    type.append(content, field.values);
    zip.add(name + ".npy", content);
  }
}

}  // namespace

Result<Bytes> npzBytes(const FileMesh& mesh) {
  Zip zip;
  const NumberType& type = numberType(mesh.doublePoints ? "float64" : "float32");
  Bytes points = npyStart(type.numpyName, mesh.points.size(), 3);
  for (const auto& p : mesh.points) type.append(points, p);
  zip.add("points.npy", points);
  zip.add("tetrahedra.npy", npyOfIds(mesh.tetrahedra, 4));
  zip.add("boundary.npy", npyOfIds(boundaryOf(mesh.tetrahedra), 3));
  std::set<std::string> taken;
  addFields(zip, "point_", mesh.pointFields, taken);
  addFields(zip, "cell_", mesh.cellFields, taken);
  return zip.finish();
}

}  // namespace qtet
