// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace vantage {

/// Coordinates of a cell on the exchange lattice.
template <int Dim>
using CellNumber = std::array<std::uint32_t, Dim>;

/// Numbers filed under lattice coordinates: open addressing, since a code looks up all neighbours of every cell.
template <int Dim>
class CellTable {
 public:
  explicit CellTable(std::size_t expected = 0) { rehash(2 * expected); }

  /// Files `value` < 2^32 - 1 under `key`, unless something is there already; false then.
  bool insert(const CellNumber<Dim>& key, std::uint32_t value) {
    if (2 * (size_ + 1) > slots_.size()) rehash(4 * (size_ + 1));
    Slot& slot = slots_[place(key)];
    if (slot.value != kFree) return false;
    slot = {key, value};
    ++size_;
    return true;
  }
  [[nodiscard]] std::optional<std::uint32_t> find(const CellNumber<Dim>& key) const {
    const Slot& slot = slots_[place(key)];
    return slot.value == kFree ? std::nullopt : std::optional(slot.value);
  }
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  static constexpr std::uint32_t kFree = 0xffffffffU;
  struct Slot {
    CellNumber<Dim> key;
    std::uint32_t value = kFree;
  };
  std::vector<Slot> slots_;
  std::size_t size_ = 0;

  [[nodiscard]] static bool is_same(const CellNumber<Dim>& a, const CellNumber<Dim>& b) {
    std::uint32_t differ = 0;
    for (std::size_t k = 0; k < Dim; ++k) differ |= a[k] ^ b[k];
    return differ == 0;
  }
  /// Where `key` is, or would go.
  [[nodiscard]] std::size_t place(const CellNumber<Dim>& key) const {
    std::uint64_t hash = 0;
    for (const std::uint32_t k : key) {
      hash = (hash ^ k) * 0x9e3779b97f4a7c15ULL;
      hash ^= hash >> 29U;
    }
    for (std::size_t at = hash & (slots_.size() - 1);; at = (at + 1) & (slots_.size() - 1))
      if (slots_[at].value == kFree || is_same(slots_[at].key, key)) return at;
  }
  void rehash(std::size_t wanted) {
    std::size_t capacity = 16;
    while (capacity < wanted) capacity *= 2;
    std::vector<Slot> old(capacity);
    old.swap(slots_);
    for (const Slot& slot : old)
      if (slot.value != kFree) slots_[place(slot.key)] = slot;
  }
};

/// Calls `visit(cell)` for all cells from `low` to `high`, the first axis fastest.
template <int Dim, class Visit>
void each_cell_between(const CellNumber<Dim>& low, const CellNumber<Dim>& high, Visit&& visit) {
  for (CellNumber<Dim> at = low;;) {
    visit(at);
    std::size_t a = 0;
    while (a < Dim && at[a] == high[a]) {
      at[a] = low[a];
      ++a;
    }
    if (a == Dim) return;
    ++at[a];
  }
}

}  // namespace vantage
