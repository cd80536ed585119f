// A folder with two logs and a viewer, opened, as most server tests need it.
#pragma once

#include <stdexcept>

#include "server/routes/viewer_files.h"
#include "server/store/mesh_store.h"
#include "server/wire/content_coding.h"
#include "tests/server/store/synthetic_log.h"

namespace qtet::test {

class ServedFolder {
 public:
  static constexpr const char* kPage =
      "<!doctype html><title>viewer</title><script type=\"module\" "
      "src=\"assets/app-1a2b.js\"></script>"
      "<link rel=\"icon\" href=\"i.svg\"><link rel=\"stylesheet\" href=\"a.css\">"
      "<link rel=\"preload\" as=\"fetch\" crossorigin href=\"assets/codec.wasm\">"
      "<!--mesh-poster--><h1><!--mesh-name--></h1>";

  static constexpr std::string_view kScript = "console.log(1)";
  static Bytes compressedScript() {
    return encoded({kScript.begin(), kScript.end()}, ContentCoding::kGzip);
  }

  ServedFolder() {
    logs_.write("noise.qtet", makeLog({.chunks = 12}));
    logs_.write("a b.qtet", makeLog({.chunks = 2, .fields = {}, .seed = 7}));
    logs_.write("readme.txt", "not a log");
    viewer_.write("index.html", kPage);
    viewer_.write("assets/app-1a2b.js", kScript);
    viewer_.write("assets/app-1a2b.js.gz", compressedScript());
    viewer_.write("assets/alone.gz", "an archive");
    viewer_.write("assets/codec.wasm", std::string_view("\0asm", 4));
    viewer_.write("docs/index.html", "<title>docs</title>");
    viewer_.write(".secret", "hidden");
    viewer_.write(".git/config", "hidden");
    Result<MeshStore> store = MeshStore::open(logs_.path());
    Result<ViewerFiles> viewer = ViewerFiles::load(viewer_.path());
    if (!store || !viewer) throw std::runtime_error("the fixture cannot be opened");
    store_ = std::move(*store);
    files_ = std::move(*viewer);
  }

  [[nodiscard]] const MeshStore& store() const { return store_; }
  [[nodiscard]] const ViewerFiles& viewer() const { return files_; }
  [[nodiscard]] const ServedMesh& mesh() const { return *store_.find("noise"); }
  /// An address under the digest of `noise`.
  [[nodiscard]] std::string log(const std::string& rest = "log") const {
    return "/v1/logs/" + mesh().log.digest() + "/" + rest;
  }
  [[nodiscard]] std::string file() const {
    return {mesh().log.bytes().begin(), mesh().log.bytes().end()};
  }
  [[nodiscard]] const std::filesystem::path& logFolder() const { return logs_.path(); }
  [[nodiscard]] const std::filesystem::path& viewerFolder() const { return viewer_.path(); }

 private:
  TempFolder logs_, viewer_;
  MeshStore store_;
  ViewerFiles files_;
};

}  // namespace qtet::test
