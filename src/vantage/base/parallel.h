// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

namespace vantage {

/// Calls `body(begin, end)` over [0, count) in chunks of `chunk`, in any order and on any thread. Bodies write only to their own slots.
void parallel_chunks(std::size_t count, std::size_t chunk, const std::function<void(std::size_t, std::size_t)>& body);

/// Calls `body(i)` for every i in [0, count).
template <class Body>
void parallel_for(std::size_t count, std::size_t chunk, Body&& body) {
  parallel_chunks(count, chunk, [&body](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}

/// Folds `chunk_value(begin, end)` of fixed-size chunks in their order with `join(Value&, Value)`: same bits for any number of threads.
template <class Value, class ChunkValue, class Join>
[[nodiscard]] Value parallel_reduce(std::size_t count, std::size_t chunk, Value start, ChunkValue&& chunk_value, Join&& join) {
  std::vector<Value> parts((count + chunk - 1) / chunk, start);
  parallel_chunks(count, chunk, [&](std::size_t begin, std::size_t end) { parts[begin / chunk] = chunk_value(begin, end); });
  for (Value& part : parts) join(start, std::move(part));
  return start;
}

/// While it lives, at most `threads` threads work (0: all cores).
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  struct Control;
  std::unique_ptr<Control> control_;
};

}  // namespace vantage
