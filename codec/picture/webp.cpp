#include "codec/picture/webp.h"

#include <webp/encode.h>

#include <cassert>
#include <memory>
#include <string>

namespace qtet {
namespace {

/// Slower methods save 1 % of the bytes.
constexpr int kMethod = 4;
/// A picture that fades out shows bands below this.
constexpr int kAlphaQuality = 90;

}  // namespace

Result<Bytes> encodeWebp(const Bytes& pixels, int width, int height, int quality) {
  assert(width > 0 && width <= WEBP_MAX_DIMENSION && height > 0 && height <= WEBP_MAX_DIMENSION);
  assert(pixels.size() ==
         std::size_t{4} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  WebPConfig config;
  WebPPicture picture;
  if (WebPConfigInit(&config) == 0 || WebPPictureInit(&picture) == 0)
    return fail(ErrorCode::kIo, "libwebp is of another version than its headers; install it anew");
  const std::unique_ptr<WebPPicture, decltype(&WebPPictureFree)> frees(&picture, WebPPictureFree);
  config.quality = static_cast<float>(quality);
  config.method = kMethod;
  config.alpha_quality = kAlphaQuality;
  picture.use_argb = 1;
  picture.width = width;
  picture.height = height;
  WebPMemoryWriter writer;
  WebPMemoryWriterInit(&writer);
  const std::unique_ptr<WebPMemoryWriter, decltype(&WebPMemoryWriterClear)> clears(
      &writer, WebPMemoryWriterClear);
  picture.writer = WebPMemoryWrite;
  picture.custom_ptr = &writer;
  if (WebPPictureImportRGBA(&picture, pixels.data(), 4 * width) == 0 ||
      WebPEncode(&config, &picture) == 0)
    return fail(ErrorCode::kIo, "libwebp cannot write the picture: error " +
                                    std::to_string(static_cast<int>(picture.error_code)));
  return Bytes(writer.mem, writer.mem + writer.size);
}

}  // namespace qtet
