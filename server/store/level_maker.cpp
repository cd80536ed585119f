#include "server/store/level_maker.h"

#include <exception>
#include <new>
#include <string>

#include "codec/files/mesh_file.h"
#include "codec/picture/poster.h"
#include "server/store/preview.h"
#include "server/store/series_maker.h"

namespace qtet {
namespace {

Result<Bytes> written(LatticeMesh& mesh, const LevelRequest& request) {
  for (std::size_t f = 0; f < request.names.size(); ++f) mesh.fields[f].name = request.names[f];
  switch (request.form) {
    case LevelForm::kPng: return previewPng(mesh);
    case LevelForm::kWebp: return posterWebp(mesh, request.mesh->manifest);
    default: return meshFileBytes(mesh, "." + std::string(formName(request.form)));
  }
}

Result<Bytes> fileOf(const LevelRequest& request, const std::stop_token& stop,
                     SeriesMaker& series) {
  if (request.point) return series.make(request, stop);
  Result<LatticeMesh> mesh = meshAtLevel(request.mesh->log, request.level, request.fields, stop);
  if (!mesh) return std::unexpected(mesh.error());
  return written(*mesh, request);
}

}  // namespace

Result<Bytes> makeLevel(const LevelRequest& request, const std::stop_token& stop,
                        SeriesMaker& series) {
  try {
    Result<Bytes> file = fileOf(request, stop, series);
    if (!file || stop.stop_requested()) return file;
    return encoded(std::move(*file), request.coding);
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::kIo, "there is not enough memory for this level; ask for a coarser one");
  } catch (const std::exception& error) {  // of a library: it ends one job, not the server
    return fail(ErrorCode::kBadCodec, std::string("this level cannot be written: ") + error.what());
  }
}

Result<Bytes> makeLevel(const LevelRequest& request, const std::stop_token& stop) {
  SeriesMaker series;
  return makeLevel(request, stop, series);
}

Result<LevelFile> makeLevelHere(const LevelRequest& request, const std::stop_token& stop) {
  Result<Bytes> made = makeLevel(request, stop);
  if (!made) return std::unexpected(made.error());
  return inMemory(std::move(*made));
}

}  // namespace qtet
