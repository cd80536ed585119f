#include "server/store/level_maker.h"

#include <exception>
#include <new>
#include <string>

#include "codec/files/mesh_file.h"
#include "codec/picture/poster.h"
#include "server/store/preview.h"

namespace qtet {
namespace {

Result<Bytes> written(const LatticeMesh& mesh, const LevelRequest& request) {
  switch (request.form) {
    case LevelForm::kPng: return previewPng(mesh);
    case LevelForm::kWebp: return posterWebp(mesh, request.mesh->manifest);
    default: return meshFileBytes(mesh, "." + std::string(formName(request.form)));
  }
}

}  // namespace

Result<Bytes> makeLevel(const LevelRequest& request, const std::stop_token& stop) {
  try {
    const Result<LatticeMesh> mesh =
        meshAtLevel(request.mesh->log, request.level, request.fields, stop);
    if (!mesh) return std::unexpected(mesh.error());
    Result<Bytes> file = written(*mesh, request);
    if (!file || stop.stop_requested()) return file;
    return encoded(std::move(*file), request.coding);
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::kIo, "there is not enough memory for this level; ask for a coarser one");
  } catch (const std::exception& error) {  // of a library: it ends one job, not the server
    return fail(ErrorCode::kBadCodec, std::string("this level cannot be written: ") + error.what());
  }
}

}  // namespace qtet
