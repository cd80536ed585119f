// A picture drawn in software: convex polygons in perspective, the nearest one on top, with smooth
// edges.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "codec/picture/first_camera.h"
#include "proto/bytes.h"

namespace qtet {

/// A corner in the camera's view (FirstCamera::view), and the value there.
struct Corner {
  Vector place;
  double value;
};

class Canvas {
 public:
  /// Shows `halfExtent` (FirstCamera) from edge to edge.
  Canvas(int width, int height, const std::array<double, 2>& halfExtent);

  /// Gives each covered sample the colour that `shade` makes of the interpolated value, sRGB from 0
  /// to 1. Either side is drawn. REQUIRES: convex, in front of the eye.
  void draw(std::span<const Corner> polygon,
            const std::function<std::array<double, 3>(double value)>& shade);

  /// Fades the picture out towards its edges.
  void fade();
  /// Red, green, blue and alpha of each pixel, row by row from the top; not premultiplied.
  [[nodiscard]] Bytes pixels() const;

 private:
  void drawTriangle(const std::array<Corner, 3>& corners,
                    const std::function<std::array<double, 3>(double value)>& shade);
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }
  [[nodiscard]] double visibility(int column, int row) const;

  int width_, height_, columns_, rows_;
  std::array<double, 2> halfExtent_;
  bool fades_ = false;
  /// The inverse of the distance in front of the eye, 0 where nothing is; one a sample.
  std::vector<float> nearness_;
  std::vector<std::array<float, 3>> colours_;
};

}  // namespace qtet
