#include "simplify/commands/svg_picture.h"

#include <librsvg/rsvg.h>

#include <cmath>
#include <memory>

namespace qtet {
namespace {

template <auto release>
struct Release {
  template <class T>
  void operator()(T* thing) const {
    release(thing);
  }
};
using Document = std::unique_ptr<RsvgHandle, Release<g_object_unref>>;
using Surface = std::unique_ptr<cairo_surface_t, Release<cairo_surface_destroy>>;
using Context = std::unique_ptr<cairo_t, Release<cairo_destroy>>;

std::unexpected<Error> refused(GError* why) {
  const std::unique_ptr<GError, Release<g_error_free>> error(why);
  return fail(ErrorCode::kBadInput, std::string("the picture cannot be drawn: ") +
                                        (error ? error->message : "librsvg gives no reason"));
}

cairo_status_t append(void* to, const unsigned char* data, unsigned int size) {
  auto& bytes = *static_cast<Bytes*>(to);
  bytes.insert(bytes.end(), data, data + size);
  return CAIRO_STATUS_SUCCESS;
}

}  // namespace

Result<Bytes> pngOf(const std::string& svg, double scale) {
  GError* error = nullptr;
  const Document document(
      rsvg_handle_new_from_data(reinterpret_cast<const guint8*>(svg.data()), svg.size(), &error));
  if (!document) return refused(error);
  double width = 0, height = 0;
  if (!rsvg_handle_get_intrinsic_size_in_pixels(document.get(), &width, &height))
    return refused(nullptr);
  const int columns = static_cast<int>(std::ceil(width * scale)),
            rows = static_cast<int>(std::ceil(height * scale));
  const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, columns, rows));
  const Context context(cairo_create(surface.get()));
  const RsvgRectangle page{0, 0, width * scale, height * scale};
  if (!rsvg_handle_render_document(document.get(), context.get(), &page, &error))
    return refused(error);
  Bytes png;
  if (cairo_surface_write_to_png_stream(surface.get(), append, &png) != CAIRO_STATUS_SUCCESS)
    return fail(ErrorCode::kIo, "there is no memory for a picture of " + std::to_string(columns) +
                                    " x " + std::to_string(rows) + " pixels");
  return png;
}

}  // namespace qtet
