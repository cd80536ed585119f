// A level's finished bytes, wherever they lie.
#pragma once

#include <memory>

#include "proto/bytes.h"

namespace qtet {

/// `bytes` live as long as `owner`.
struct LevelFile {
  ByteView bytes;
  std::shared_ptr<const void> owner;
};

}  // namespace qtet
