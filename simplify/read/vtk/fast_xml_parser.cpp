#include "simplify/read/vtk/fast_xml_parser.h"

#include <libdeflate.h>
#include <vtkBase64InputStream.h>
#include <vtkBase64Utilities.h>
#include <vtkDataCompressor.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkZLibDataCompressor.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <istream>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>

#include "simplify/read/vtu/base64_digits.h"

namespace qtet {
namespace {

/// Takes from the file by the thousand what VTK's takes four characters at a time. Data that end
/// too early are an error here: VTK's leaves the rest of an uncompressed array as the memory was,
/// and says nothing.
class FastBase64 : public vtkBase64InputStream {
 public:
  vtkTypeMacro(FastBase64, vtkBase64InputStream) FastBase64(const FastBase64&) = delete;
  FastBase64& operator=(const FastBase64&) = delete;

  std::size_t Read(void* data, std::size_t length) override {
    auto* out = static_cast<unsigned char*>(data);
    auto* const end = out + length;
    if (this->BufferLength > 0)
      out += Superclass::Read(out, std::min(length, static_cast<std::size_t>(this->BufferLength)));
    while (this->BufferLength == 0 && end - out >= 3) {
      const std::size_t triplets =
          std::min<std::size_t>(kTripletsAtOnce, static_cast<std::size_t>(end - out) / 3);
      this->Stream->read(reinterpret_cast<char*>(characters_.data()),
                         static_cast<std::streamsize>(4 * triplets));
      const std::size_t there = static_cast<std::size_t>(this->Stream->gcount()) / 4;
      const std::size_t written = decode(there, out);
      out += written;
      // the data end here: VTK's sign that nothing more is to be read
      if (written < 3 * triplets) this->BufferLength = -1;
    }
    if (this->BufferLength == 0 && out != end)
      out += Superclass::Read(out, static_cast<std::size_t>(end - out));
    return out == end ? length : 0;
  }

 protected:
  FastBase64() = default;

 private:
  static constexpr std::size_t kTripletsAtOnce = 4096;

  /// How many bytes so many groups of four characters gave: fewer than three each if one of them is
  /// no whole triplet.
  std::size_t decode(std::size_t groups, unsigned char* out) const {
    for (std::size_t i = 0; i < groups; ++i, out += 3) {
      const unsigned char* c = characters_.data() + 4 * i;
      const unsigned a = kBase64Digits[c[0]], b = kBase64Digits[c[1]], d = kBase64Digits[c[2]],
                     e = kBase64Digits[c[3]];
      if ((a | b | d | e) > 63) {  // the filler among them: VTK's way
        const auto bytes = static_cast<std::size_t>(
            vtkBase64Utilities::DecodeTriplet(c[0], c[1], c[2], c[3], out, out + 1, out + 2));
        if (bytes < 3) return 3 * i + bytes;
        continue;
      }
      const unsigned bits = a << 18 | b << 12 | d << 6 | e;
      out[0] = static_cast<unsigned char>(bits >> 16);
      out[1] = static_cast<unsigned char>(bits >> 8);
      out[2] = static_cast<unsigned char>(bits);
    }
    return 3 * groups;
  }

  std::array<unsigned char, 4 * kTripletsAtOnce> characters_{};
};

/// Reads what vtkZLibDataCompressor writes, by libdeflate.
class FastInflate : public vtkDataCompressor {
 public:
  static FastInflate* New();
  vtkTypeMacro(FastInflate, vtkDataCompressor) FastInflate(const FastInflate&) = delete;
  FastInflate& operator=(const FastInflate&) = delete;

  std::size_t GetMaximumCompressionSpace(std::size_t size) override {
    return zlib_->GetMaximumCompressionSpace(size);
  }
  void SetCompressionLevel(int level) override { zlib_->SetCompressionLevel(level); }
  int GetCompressionLevel() override { return zlib_->GetCompressionLevel(); }

 protected:
  FastInflate() = default;
  std::size_t CompressBuffer(const unsigned char* from, std::size_t size, unsigned char* to,
                             std::size_t space) override {
    return zlib_->Compress(from, size, to, space);
  }
  std::size_t UncompressBuffer(const unsigned char* from, std::size_t size, unsigned char* to,
                               std::size_t space) override {
    std::size_t written = 0;
    if (inflater_ &&
        libdeflate_zlib_decompress(inflater_.get(), from, size, to, space, &written) ==
            LIBDEFLATE_SUCCESS &&
        written == space)
      return written;
    // so that damage is reported as VTK reports it
    return zlib_->Uncompress(from, size, to, space);
  }

 private:
  struct Free {
    void operator()(libdeflate_decompressor* inflater) const {
      libdeflate_free_decompressor(inflater);
    }
  };
  std::unique_ptr<libdeflate_decompressor, Free> inflater_{libdeflate_alloc_decompressor()};
  vtkNew<vtkZLibDataCompressor> zlib_;
};
vtkStandardNewMacro(FastInflate);

/// The most components of an array in a file. VTK makes a name for each, which takes minutes for
/// 2^32.
constexpr std::uint32_t kMaxComponents = 1 << 16;

bool isComponentCount(std::string_view text) {
  std::uint32_t count = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), count);
  return read.ec == std::errc{} && read.ptr == text.data() + text.size() && count <= kMaxComponents;
}

class FastParser;

/// One of VTK's streams, which reads nothing more where the sizes of a compressed array's blocks
/// contradict each other. There VTK would read beyond its own arrays.
template <class Stream>
class Guarded : public Stream {
 public:
  explicit Guarded(const FastParser& parser) : parser_(parser) {}
  Guarded(const Guarded&) = delete;
  Guarded& operator=(const Guarded&) = delete;

  void StartReading() override {
    Stream::StartReading();
    isFirst_ = true;
  }
  int Seek(vtkTypeInt64 offset) override {
    isFirst_ = false;
    return Stream::Seek(offset);
  }
  std::size_t Read(void* data, std::size_t length) override;

 private:
  const FastParser& parser_;
  bool isFirst_ = false;  ///< what is read next begins an array
};

class FastParser : public vtkXMLDataParser {
 public:
  static FastParser* New();
  vtkTypeMacro(FastParser, vtkXMLDataParser) FastParser(const FastParser&) = delete;
  FastParser& operator=(const FastParser&) = delete;

  void SetCompressor(vtkDataCompressor* compressor) override {
    if (vtkZLibDataCompressor::SafeDownCast(compressor))
      Superclass::SetCompressor(vtkNew<FastInflate>());
    else
      Superclass::SetCompressor(compressor);
  }

  /// Whether the first header of a compressed array is sound. It has the number of blocks, the size
  /// of one, and the size of the last if it is a smaller one. The blocks' sizes stand in the `left`
  /// bytes behind.
  [[nodiscard]] bool isSound(const void* data, std::size_t length, std::uint64_t left) const {
    const auto wordBytes = static_cast<std::size_t>(this->HeaderType) / 8;
    if (!this->Compressor || length != 3 * wordBytes) return true;
    const auto* bytes = static_cast<const unsigned char*>(data);
    std::array<std::uint64_t, 3> words{};
    for (std::size_t i = 0; i < length; ++i) {
      const std::size_t within = this->ByteOrder == vtkXMLDataParser::BigEndian
                                     ? wordBytes - 1 - i % wordBytes
                                     : i % wordBytes;
      words[i / wordBytes] |= std::uint64_t{bytes[i]} << (8 * within);
    }
    const auto [blocks, size, last] = words;
    return blocks == 0 ? last == 0 : size > 0 && last <= size && blocks <= left / wordBytes;
  }

 protected:
  FastParser() {
    setStream<FastBase64>(this->InlineDataStream);
    setStream<FastBase64>(this->AppendedDataStream);
  }
  void StartElement(const char* name, const char** attributes) override {
    for (const char** at = attributes; at[0] && at[1]; at += 2)
      if (std::string_view(at[0]) == "NumberOfComponents" && !isComponentCount(at[1])) {
        vtkErrorMacro(<< "an element <" << name << "> has NumberOfComponents=\"" << at[1]
                      << "\", which is no number from 0 to " << kMaxComponents);
        at[1] = "1";  // VTK goes on, and would name each component
      }
    Superclass::StartElement(name, attributes);  // gives raw data a stream of its own
    if (!FastBase64::SafeDownCast(this->AppendedDataStream) &&
        !dynamic_cast<Guarded<vtkInputStream>*>(this->AppendedDataStream))
      setStream<vtkInputStream>(this->AppendedDataStream);
  }

 private:
  template <class Stream>
  void setStream(vtkInputStream*& place) {
    place->Delete();
    place = new Guarded<Stream>(*this);
    place->InitializeObjectBase();
  }
};

template <class Stream>
std::size_t Guarded<Stream>::Read(void* data, std::size_t length) {
  const std::size_t got = Stream::Read(data, length);
  if (!std::exchange(isFirst_, false) || got < length) return got;
  const auto at = this->Stream->tellg();
  this->Stream->seekg(0, std::ios::end);
  const auto left = this->Stream->tellg() - at;
  this->Stream->seekg(at);
  return parser_.isSound(data, length, static_cast<std::uint64_t>(left)) ? got : 0;
}
vtkStandardNewMacro(FastParser);

}  // namespace

vtkXMLDataParser* newFastXmlParser() { return FastParser::New(); }

}  // namespace qtet
