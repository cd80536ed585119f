// A sorted sequence whose copies share what they have in common, for snapshots of large folders.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <functional>
#include <iterator>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace qtet {

/// Values in the order of their keys, each key once. KeyOf gives the key of a value. A copy takes
/// one pointer for each block of values, and a change copies one block. A copy is never changed by
/// changes of another. Iterators are valid until the next change.
template <class Value, class KeyOf>
class SortedBlocks {
  using Block = std::vector<Value>;
  using BlockPointer = std::shared_ptr<const Block>;

 public:
  using Key = std::invoke_result_t<KeyOf, const Value&>;
  /// Values of a block: a copy of a million takes some thousand pointers, and a change a
  /// microsecond.
  static constexpr std::size_t kMaxBlock = 256;

  class Iterator {
   public:
    using iterator_category = std::forward_iterator_tag;
    using value_type = Value;
    using difference_type = std::ptrdiff_t;
    using pointer = const Value*;
    using reference = const Value&;

    Iterator() = default;
    reference operator*() const {
      assert(block_ != nullptr && index_ < (*block_)->size());
      return (**block_)[index_];
    }
    pointer operator->() const { return &**this; }
    Iterator& operator++() {
      if (++index_ == (*block_)->size()) *this = Iterator(block_ + 1, 0);
      return *this;
    }
    Iterator operator++(int) { return std::exchange(*this, std::next(*this)); }
    bool operator==(const Iterator&) const = default;

   private:
    friend class SortedBlocks;
    Iterator(const BlockPointer* block, std::size_t index) : block_(block), index_(index) {}

    const BlockPointer* block_ = nullptr;
    std::size_t index_ = 0;
  };

  /// REQUIRES: sorted by their keys, each key once.
  [[nodiscard]] static SortedBlocks ofSorted(std::vector<Value> values) {
    assert(std::ranges::adjacent_find(values, std::not_fn(std::less()), KeyOf()) == values.end());
    SortedBlocks out;
    out.size_ = values.size();
    for (std::size_t at = 0; at < values.size(); at += kMaxBlock) {
      const auto begin = values.begin() + static_cast<std::ptrdiff_t>(at);
      const auto count = static_cast<std::ptrdiff_t>(std::min(kMaxBlock, values.size() - at));
      out.blocks_.push_back(std::make_shared<const Block>(std::move_iterator(begin),
                                                          std::move_iterator(begin + count)));
    }
    return out;
  }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] Iterator begin() const { return {blocks_.data(), 0}; }
  [[nodiscard]] Iterator end() const { return {blocks_.data() + blocks_.size(), 0}; }

  /// The first whose key is not below `key`.
  [[nodiscard]] Iterator lowerBound(const Key& key) const {
    const auto block = blockOf(key);
    if (block == blocks_.end()) return end();
    return {&*block, static_cast<std::size_t>(placeIn(**block, key) - (*block)->begin())};
  }
  /// The first whose key is above `key`.
  [[nodiscard]] Iterator upperBound(const Key& key) const {
    const Iterator at = lowerBound(key);
    return at != end() && KeyOf()(*at) == key ? std::next(at) : at;
  }
  /// nullptr: there is none.
  [[nodiscard]] const Value* find(const Key& key) const {
    const Iterator at = lowerBound(key);
    return at != end() && KeyOf()(*at) == key ? &*at : nullptr;
  }
  [[nodiscard]] bool contains(const Key& key) const { return find(key) != nullptr; }

  /// Takes the place of the value with the same key, if there is one.
  void put(Value value) {
    if (blocks_.empty()) blocks_.push_back(std::make_shared<const Block>());
    const auto found = blockOf(KeyOf()(value));
    const auto index = std::min(found - blocks_.begin(), std::ssize(blocks_) - 1);
    Block block = *blocks_[static_cast<std::size_t>(index)];
    const auto place = placeIn(block, KeyOf()(value));
    if (place != block.end() && KeyOf()(*place) == KeyOf()(value)) {
      block[static_cast<std::size_t>(place - block.begin())] = std::move(value);
    } else {
      const bool atTheEnd = found == blocks_.end();
      block.insert(place, std::move(value));
      ++size_;
      if (block.size() > kMaxBlock) split(block, index, atTheEnd);
    }
    blocks_[static_cast<std::size_t>(index)] = std::make_shared<const Block>(std::move(block));
  }
  /// Whether there was one.
  bool remove(const Key& key) {
    const auto found = blockOf(key);
    if (found == blocks_.end()) return false;
    const auto place = placeIn(**found, key);
    if (KeyOf()(*place) != key) return false;
    const auto at = blocks_.begin() + (found - blocks_.begin());
    assert(size_ > 0);
    --size_;
    if ((*at)->size() == 1) {
      blocks_.erase(at);
      return true;
    }
    Block block = **at;
    block.erase(block.begin() + (place - (*at)->begin()));
    *at = std::make_shared<const Block>(std::move(block));
    return true;
  }

 private:
  static bool isBelow(const Value& value, const Key& key) { return KeyOf()(value) < key; }
  /// The only block that may hold `key`.
  auto blockOf(const Key& key) const {
    return std::partition_point(blocks_.begin(), blocks_.end(), [&](const BlockPointer& block) {
      return !block->empty() && isBelow(block->back(), key);
    });
  }
  static auto placeIn(const Block& block, const Key& key) {
    return std::lower_bound(block.begin(), block.end(), key, isBelow);
  }
  /// Moves the latter half into a block of its own. Values that come in order fill their blocks.
  void split(Block& block, std::ptrdiff_t index, bool atTheEnd) {
    const auto keep = static_cast<std::ptrdiff_t>(atTheEnd ? kMaxBlock : kMaxBlock / 2);
    blocks_.insert(blocks_.begin() + index + 1,
                   std::make_shared<const Block>(std::move_iterator(block.begin() + keep),
                                                 std::move_iterator(block.end())));
    block.erase(block.begin() + keep, block.end());
  }

  std::vector<BlockPointer> blocks_;  // none of them is empty
  std::size_t size_ = 0;
};

}  // namespace qtet
