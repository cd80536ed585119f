// A level's finished bytes, wherever they lie.
#pragma once

#include <memory>
#include <utility>

#include "proto/bytes.h"

namespace qtet {

/// `bytes` live as long as `owner`.
struct LevelFile {
  ByteView bytes;
  std::shared_ptr<const void> owner;
};

/// The bytes in memory.
[[nodiscard]] inline LevelFile inMemory(Bytes bytes) {
  const auto owner = std::make_shared<const Bytes>(std::move(bytes));
  return {*owner, owner};
}

}  // namespace qtet
