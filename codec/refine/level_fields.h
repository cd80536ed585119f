// The fields of a level, decoded when they are asked for and forgotten when nothing needs them any
// more.
#pragma once

#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

#include "codec/refine/log_file.h"

namespace qtet {

class Refiner;

/// Fields of one association. While they are asked for in ascending order, each is decoded once. In
/// memory are the present one and those that later ones are predicted from. In another order they
/// are decoded again.
class LevelFields {
 public:
  /// `log` and `refiner`, which has decoded none of these fields, must outlive it. `wanted`
  /// ascends.
  LevelFields(const LogFile& log, Refiner& refiner, std::vector<std::uint32_t> wanted,
              std::stop_token stop);
  ~LevelFields();
  LevelFields(const LevelFields&) = delete;
  LevelFields& operator=(const LevelFields&) = delete;

  /// The field's integers, until the next call. After an error, or a stop, they are none, and
  /// status() says why.
  [[nodiscard]] std::span<const std::int32_t> integers(std::uint32_t field);
  [[nodiscard]] const Status& status() const { return status_; }

 private:
  void forgetAll();
  Status decode(std::uint32_t field);

  const LogFile& log_;
  Refiner& refiner_;
  const std::stop_token stop_;
  const std::vector<std::uint32_t> needed_;  // with their parents, ascending
  const std::vector<std::vector<std::uint32_t>> uses_;
  std::size_t next_ = 0;  // of needed_: the first that is not decoded
  Status status_{};
};

}  // namespace qtet
