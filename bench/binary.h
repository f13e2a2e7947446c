// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <fstream>
#include <vector>

namespace vantage::bench {

/// Appends the number of values and their bytes, as they lie in this machine's memory.
template <class T>
void put(std::ofstream& file, const std::vector<T>& values) {
  const std::uint64_t count = values.size();
  const void *head = &count, *body = values.data();
  file.write(static_cast<const char*>(head), sizeof count);
  file.write(static_cast<const char*>(body), static_cast<std::streamsize>(count * sizeof(T)));
}

/// At most the first `most` of what `put` wrote; the file stands after all of them. The file fails if it is cut off.
template <class T>
std::vector<T> get(std::ifstream& file, std::size_t most = SIZE_MAX) {
  std::uint64_t count = 0;
  void* head = &count;
  file.read(static_cast<char*>(head), sizeof count);
  if (!file) return {};
  std::vector<T> values(std::min<std::size_t>(count, most));
  void* body = values.data();
  file.read(static_cast<char*>(body), static_cast<std::streamsize>(values.size() * sizeof(T)));
  file.seekg(static_cast<std::streamoff>((count - values.size()) * sizeof(T)), std::ios::cur);
  return values;
}

}  // namespace vantage::bench
