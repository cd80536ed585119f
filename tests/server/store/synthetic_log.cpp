#include "tests/server/store/synthetic_log.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>
#include <stdexcept>

#include "codec/log/log_manifest.h"
#include "proto/crc32c.h"

namespace qtet::test {
namespace {

namespace fs = std::filesystem;

Manifest makeManifest(const SyntheticLog& options) {
  Manifest out;
  out.generator = "test";
  out.source = "noise.vtu";
  out.latticeBits = 16;
  for (std::size_t f = 0; f < options.fields.size(); ++f) {
    const std::uint32_t components = f == 1 ? 3 : 1;
    out.fields.push_back({options.fields[f],
                          components,
                          "float32",
                          "point",
                          12,
                          0.5,
                          std::vector<double>(components, 0.0),
                          {0, 1}});
  }
  for (std::uint32_t k = 0; k < options.chunks; ++k)
    out.levels.push_back({k, 100 + 10 * k, 50 + 5 * k, 60 + k, k});
  if (options.errors)
    for (ManifestLevel& level : out.levels) {
      const double error = level.level + 1 == out.levels.size()
                               ? 0
                               : std::ldexp(0.5, -static_cast<int>(level.level));
      level.error = LevelError{{error, error},
                               {error, error},
                               0,
                               0,
                               std::vector<FieldError>(out.fields.size(), {error, error})};
    }
  return out;
}

struct Built {
  LogIndex index;
  Bytes blocks;
};

Built build(const SyntheticLog& options) {
  std::mt19937 random(options.seed);
  const Manifest manifest = makeManifest(options);
  Built out;
  out.index.positionBits = 16;
  out.index.manifest = manifestBlock(manifest).value();
  for (const ManifestField& field : manifest.fields)
    out.index.fields.push_back({field.components, Association::kPoint});
  for (std::uint32_t k = 0; k < options.chunks; ++k) {
    ChunkEntry chunk;
    chunk.firstLevel = chunk.lastLevel = k;
    chunk.newVertices = 5;
    chunk.newTetrahedra = 10;
    chunk.records = k == 0 ? 0 : 5;
    for (std::uint32_t part = 0; part < out.index.parts(); ++part) {
      BlockEntry block;
      block.size =
          random() % 8 == 0 ? 0 : static_cast<std::uint32_t>(random() % options.largestBlock);
      // records without bytes would be refused
      if (part == kStructurePart) block.size = std::max(block.size, 1u);
      Bytes noise(block.size);
      for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(random());
      block.crc = crc32c(noise);
      out.blocks.insert(out.blocks.end(), noise.begin(), noise.end());
      chunk.blocks.push_back(block);
    }
    out.index.chunks.push_back(std::move(chunk));
  }
  // No offset is stored, so the head's size is known before they are.
  std::uint64_t offset = out.index.encode().size();
  for (ChunkEntry& chunk : out.index.chunks) {
    chunk.offset = offset;
    for (BlockEntry& block : chunk.blocks) block.offset = offset, offset += block.size;
  }
  out.index.fileBytes = offset;
  return out;
}

}  // namespace

Bytes makeLog(const SyntheticLog& options) {
  const Built built = build(options);
  Bytes out = built.index.encode();
  out.insert(out.end(), built.blocks.begin(), built.blocks.end());
  return out;
}

LogIndex makeIndex(const SyntheticLog& options) { return build(options).index; }

TempFolder::TempFolder() {
  std::string name = (fs::temp_directory_path() / "qtet-unit-test.XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr)
    throw std::runtime_error("no temporary folder can be made");
  path_ = name;
}

TempFolder::~TempFolder() {
  std::error_code ec;
  fs::remove_all(path_, ec);
}

void TempFolder::write(const std::string& name, ByteView bytes) const {
  const fs::path path = path_ / name;
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

void TempFolder::write(const std::string& name, std::string_view text) const {
  write(name, ByteView(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

}  // namespace qtet::test
